// float_mul: a * b of binary32, exactly rounded in the direction of round_i.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    ctu::numeric::mul (model/numeric/round.h)
//
// Arithmetic: subnormals as any number; 0 * infinity and NaN operands give 0x7fc00000; the sign of zeros and infinities
// as IEEE 754; overflow as float_round says. Four steps: multiply, count, shift, round; the LATENCY registers are spread
// over the places behind each of them, the last place first.
`include "float_format.svh"

module float_mul #(
    parameter int LATENCY = 4
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] a_i,
    input  logic [31:0] b_i,
    input  logic [ 1:0] round_i,
    output logic [31:0] result_o
);
  // Registers behind the four steps.
  localparam int REGISTERS_1 = LATENCY / 4;
  localparam int REGISTERS_2 = 2 * LATENCY / 4 - LATENCY / 4;
  localparam int REGISTERS_3 = 3 * LATENCY / 4 - 2 * LATENCY / 4;
  localparam int REGISTERS_4 = LATENCY - 3 * LATENCY / 4;

  // 1: the exact product of the significands, 2 places before its point, and the sum of the biased exponents.
  logic [47:0] product;
  logic [8:0] exponents;
  logic sign, infinite, nan;
  logic a_zero, b_zero, a_infinite, b_infinite;
  always_comb begin
    product = {24'd0, a_i[30:23] != 8'd0, a_i[22:0]} * {24'd0, b_i[30:23] != 8'd0, b_i[22:0]};
    // A subnormal has the exponent of the smallest normal numbers, and no hidden one.
    exponents = {1'b0, a_i[30:24], a_i[23] | (a_i[30:23] == 8'd0)} +
                {1'b0, b_i[30:24], b_i[23] | (b_i[30:23] == 8'd0)};
    sign = a_i[31] ^ b_i[31];
    a_zero = a_i[30:0] == 31'd0;
    b_zero = b_i[30:0] == 31'd0;
    a_infinite = a_i[30:0] == 31'h7f800000;
    b_infinite = b_i[30:0] == 31'h7f800000;
    infinite = a_infinite || b_infinite;
    nan = a_i[30:0] > 31'h7f800000 || b_i[30:0] > 31'h7f800000 || (a_zero && b_infinite) || (a_infinite && b_zero);
  end

  logic [47:0] product_q1;
  logic [8:0] exponents_q1;
  logic sign_q1, infinite_q1, nan_q1;
  logic [1:0] round_q1;
  pipe_row #(
      .WIDTH(62),
      .DEPTH(REGISTERS_1)
  ) row_1 (
      .clk_i,
      .enable_i,
      .data_i({product, exponents, sign, infinite, nan, round_i}),
      .data_o({product_q1, exponents_q1, sign_q1, infinite_q1, nan_q1, round_q1})
  );

  // 2: how far the highest one is from the top, and how far it may move: the exponent must not fall below 1. With its
  // highest place at 2^(exponents - 126 - 127) the product has exponent 1 when it moves up by exponents - 127 places,
  // or down where that is negative.
  logic [5:0] zeros, shift;
  logic [8:0] room, exponent;
  logic shift_down;
  leading_zeros #(
      .WIDTH(64)
  ) count (
      .value_i({product_q1, 16'd0}),
      .count_o(zeros)
  );
  always_comb begin
    shift_down = exponents_q1 < 9'd127;
    room = shift_down ? 9'd127 - exponents_q1 : exponents_q1 - 9'd127;
    if (shift_down) shift = room > 9'd63 ? 6'd63 : room[5:0];
    else shift = {3'd0, zeros} < room ? zeros : room[5:0];
    exponent = shift_down ? 9'd1 : room + 9'd1 - {3'd0, shift};
  end

  logic [47:0] product_q2;
  logic [8:0] exponent_q2;
  logic [5:0] shift_q2;
  logic shift_down_q2, sign_q2, infinite_q2, nan_q2;
  logic [1:0] round_q2;
  pipe_row #(
      .WIDTH(69),
      .DEPTH(REGISTERS_2)
  ) row_2 (
      .clk_i,
      .enable_i,
      .data_i({product_q1, exponent, shift, shift_down, sign_q1, infinite_q1, nan_q1, round_q1}),
      .data_o({product_q2, exponent_q2, shift_q2, shift_down_q2, sign_q2, infinite_q2, nan_q2, round_q2})
  );

  // 3: the product in its place; what falls off below is sticky.
  logic [47:0] placed;
  logic lost;
  always_comb begin
    placed = shift_down_q2 ? product_q2 >> shift_q2 : product_q2 << shift_q2;
    lost = shift_down_q2 && (product_q2 & ~(48'hffffffffffff << shift_q2)) != 48'd0;
`ifdef CTU_MUTATE_SUBNORMAL_STICKY
    lost = 1'b0;
`endif
  end

  logic [23:0] significand_q3;
  logic [8:0] exponent_q3;
  logic guard_q3, sticky_q3, sign_q3, infinite_q3, nan_q3;
  logic [1:0] round_q3;
  pipe_row #(
      .WIDTH(40),
      .DEPTH(REGISTERS_3)
  ) row_3 (
      .clk_i,
      .enable_i,
`ifdef CTU_MUTATE_PRODUCT_STICKY
      .data_i({placed[47:23], placed[22:1] != 22'd0 || lost, exponent_q2, sign_q2, infinite_q2, nan_q2, round_q2}),
`else
      .data_i({placed[47:23], placed[22:0] != 23'd0 || lost, exponent_q2, sign_q2, infinite_q2, nan_q2, round_q2}),
`endif
      .data_o({significand_q3, guard_q3, sticky_q3, exponent_q3, sign_q3, infinite_q3, nan_q3, round_q3})
  );

  // 4: rounded and packed.
  float_finish #(
      .LATENCY(REGISTERS_4)
  ) finish (
      .clk_i,
      .enable_i,
      .sign_i(sign_q3),
      .exponent_i(exponent_q3),
      .significand_i(significand_q3),
      .guard_i(guard_q3),
      .sticky_i(sticky_q3),
      .infinite_i(infinite_q3),
      .nan_i(nan_q3),
      .round_i(round_q3),
      .result_o
  );
endmodule
