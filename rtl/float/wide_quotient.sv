// wide_quotient: a / b of wide numbers (wide_format.svh), rounded once.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    round24(a / b) of model/intersect/sphere_test.cpp
//
// Arithmetic: b is not zero (if it is, the result says nothing). Steps: those of quotient_digits, and round.
`include "wide_format.svh"

module wide_quotient #(
    parameter int LATENCY = 16
) (
    input  logic                  clk_i,
    input  logic                  enable_i,
    input  logic [`WIDE_BITS-1:0] a_i,
    input  logic [`WIDE_BITS-1:0] b_i,
    output logic [`WIDE_BITS-1:0] result_o
);
  localparam int STEPS = 27;

  logic [24:0] digits;
  logic inexact, sign, not_zero;
  logic [10:0] exponent;
  quotient_digits #(
      .LATENCY(LATENCY),
      .STEPS(STEPS),
      .EXPONENT_BITS(11),
      .SIDE_BITS(2)
  ) divide (
      .clk_i,
      .enable_i,
      .a_i(a_i[`WIDE_SIGNIFICAND]),
      .b_i(b_i[`WIDE_SIGNIFICAND]),
      .exponent_i(a_i[`WIDE_EXPONENT] - b_i[`WIDE_EXPONENT] + 11'd1023),
      .side_i({a_i[`WIDE_SIGN] ^ b_i[`WIDE_SIGN], a_i[`WIDE_NOT_ZERO]}),
      .digits_o(digits),
      .inexact_o(inexact),
      .exponent_o(exponent),
      .side_o({sign, not_zero})
  );

  logic [`WIDE_BITS-1:0] rounded;
  wide_round round (
      .sign_i(sign),
      .exponent_i(exponent),
      .significand_i(not_zero ? digits[24:1] : 24'd0),
      .guard_i(digits[0]),
`ifdef CTU_MUTATE_WIDE_RATIO_STICKY
      .sticky_i(1'b0),
`else
      .sticky_i(inexact),
`endif
      .result_o(rounded)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(LATENCY - (STEPS - 1) * LATENCY / STEPS)
  ) row (
      .clk_i,
      .enable_i,
      .data_i(rounded),
      .data_o(result_o)
  );
endmodule
