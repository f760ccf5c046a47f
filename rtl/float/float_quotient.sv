// float_quotient: the quotient of two significands as binary32, exactly rounded in one direction or in all three at
// once: the part that the dividers of binary32 share.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    the division in model/numeric/round.h
//
// Arithmetic: a_i and b_i have their highest bit set unless zero_i, infinite_i or nan_i says what the quotient is; it
// is a_i / b_i * 2^(exponent_i - 127), subnormal or overflowing as float_round says. Steps: order and 25 digits
// (quotient_digits), shift of subnormal quotients, round; the LATENCY registers are spread over the places behind each
// of them, the last place first.
module float_quotient #(
    parameter int LATENCY = 16,
    parameter bit DIRECTED = 1'b1  // 0: nearest_o alone, the others are zero
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [23:0] a_i,
    input  logic [23:0] b_i,
    input  logic [ 9:0] exponent_i,  // two's complement, -512 < exponent_i < 511
    input  logic        sign_i,
    input  logic        zero_i,
    input  logic        infinite_i,
    input  logic        nan_i,
    output logic [31:0] nearest_o,
    output logic [31:0] down_o,
    output logic [31:0] up_o
);
  localparam int DIGITS = 25;  // 24 of the significand and the guard bit
  localparam int STEPS = DIGITS + 3;

  // 1, 2: order and digits.
  logic [DIGITS-1:0] digits;
  logic [9:0] exponent_d;
  logic inexact, sign_d, zero_d, infinite_d, nan_d;
  quotient_digits #(
      .LATENCY(LATENCY),
      .STEPS(STEPS),
      .EXPONENT_BITS(10),
      .SIDE_BITS(4)
  ) divide (
      .clk_i,
      .enable_i,
      .a_i,
      .b_i,
      .exponent_i,
      .side_i({sign_i, zero_i, infinite_i, nan_i}),
      .digits_o(digits),
      .inexact_o(inexact),
      .exponent_o(exponent_d),
      .side_o({sign_d, zero_d, infinite_d, nan_d})
  );

  // 3: a quotient below the smallest normal number moves down, to exponent 1.
  logic [23:0] significand;
  logic guard, sticky;
  logic [8:0] exponent;
  subnormal_shift place (
      .digits_i(zero_d ? '0 : digits),
      .inexact_i(inexact && !zero_d),
      .exponent_i(exponent_d),
      .significand_o(significand),
      .guard_o(guard),
      .sticky_o(sticky),
      .exponent_o(exponent)
  );

  logic [23:0] significand_q;
  logic [8:0] exponent_q;
  logic guard_q, sticky_q, sign_q, infinite_q, nan_q;
  pipe_row #(
      .WIDTH(38),
      .DEPTH((STEPS - 1) * LATENCY / STEPS - (STEPS - 2) * LATENCY / STEPS)
  ) row_placed (
      .clk_i,
      .enable_i,
      .data_i({significand, guard, sticky, exponent, sign_d, infinite_d, nan_d}),
      .data_o({significand_q, guard_q, sticky_q, exponent_q, sign_q, infinite_q, nan_q})
  );

  // 4: rounded and packed, in the order of round_i's values.
  generate
    for (genvar direction = 0; direction < (DIRECTED ? 3 : 1); direction++) begin : g_round
      localparam logic [1:0] ROUND = direction[1:0];
      logic [31:0] rounded;
      float_finish #(
          .LATENCY(LATENCY - (STEPS - 1) * LATENCY / STEPS)
      ) finish (
          .clk_i,
          .enable_i,
          .sign_i(sign_q),
          .exponent_i(exponent_q),
          .significand_i(significand_q),
          .guard_i(guard_q),
          .sticky_i(sticky_q),
          .infinite_i(infinite_q),
          .nan_i(nan_q),
          .round_i(ROUND),
          .result_o(rounded)
      );
    end
  endgenerate
  assign nearest_o = g_round[0].rounded;
  generate
    if (DIRECTED) begin : g_directed
      assign down_o = g_round[1].rounded;
      assign up_o = g_round[2].rounded;
    end else begin : g_nearest
      assign down_o = 32'd0;
      assign up_o = 32'd0;
    end
  endgenerate
endmodule
