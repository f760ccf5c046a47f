// float_finish: the last step of a float unit: rounded and packed, and the registers behind that.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//
// Arithmetic: float_round.
module float_finish #(
    parameter int LATENCY = 1
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic        sign_i,
    input  logic [ 8:0] exponent_i,
    input  logic [23:0] significand_i,
    input  logic        guard_i,
    input  logic        sticky_i,
    input  logic        infinite_i,
    input  logic        nan_i,
    input  logic [ 1:0] round_i,
    output logic [31:0] result_o
);
  logic [31:0] rounded;
  float_round round (
      .sign_i,
      .exponent_i,
      .significand_i,
      .guard_i,
      .sticky_i,
      .infinite_i,
      .nan_i,
      .round_i,
      .result_o(rounded)
  );
  pipe_row #(
      .WIDTH(32),
      .DEPTH(LATENCY)
  ) row (
      .clk_i,
      .enable_i,
      .data_i(rounded),
      .data_o(result_o)
  );
endmodule
