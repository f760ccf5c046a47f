// float_add: a + b, or a - b, of binary32, exactly rounded in the direction of round_i.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    ctu::numeric::add and sub (model/numeric/round.h)
//
// Arithmetic: subnormals as any number; x - x is +0, under down -0; infinity - infinity and NaN operands give
// 0x7fc00000; overflow as float_round says. Four steps: order, add, normalise, round; the LATENCY registers are spread
// over the places behind each of them, the last place first.
`include "float_format.svh"

module float_add #(
    parameter int LATENCY = 4
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] a_i,
    input  logic [31:0] b_i,
    input  logic        subtract_i,
    input  logic [ 1:0] round_i,
    output logic [31:0] result_o
);
  // Registers behind the four steps.
  localparam int REGISTERS_1 = LATENCY / 4;
  localparam int REGISTERS_2 = 2 * LATENCY / 4 - LATENCY / 4;
  localparam int REGISTERS_3 = 3 * LATENCY / 4 - 2 * LATENCY / 4;
  localparam int REGISTERS_4 = LATENCY - 3 * LATENCY / 4;

  // 1: the operand of larger magnitude first, and how far the other one must move.
  logic [31:0] larger, smaller;
  logic [7:0] larger_exponent, smaller_exponent, distance;
  logic opposite, zero_sign, sign, infinite, nan;
  always_comb begin
    larger = a_i;
    smaller = {b_i[31] ^ subtract_i, b_i[30:0]};
    opposite = larger[31] != smaller[31];
    zero_sign = opposite ? round_i == `FLOAT_ROUND_DOWN : larger[31];
`ifdef CTU_MUTATE_SIGN_OF_ZERO
    zero_sign = ~opposite & larger[31];
`endif
    infinite = a_i[30:23] == 8'hff || b_i[30:23] == 8'hff;
    nan = a_i[30:0] > 31'h7f800000 || b_i[30:0] > 31'h7f800000 ||
        (opposite && a_i[30:23] == 8'hff && b_i[30:23] == 8'hff);
    if (a_i[30:0] < b_i[30:0]) begin
      larger = {b_i[31] ^ subtract_i, b_i[30:0]};
      smaller = a_i;
    end
    sign = larger[31];
    // A subnormal has the exponent of the smallest normal numbers, and no hidden one.
    larger_exponent = larger[30:23] == 8'd0 ? 8'd1 : larger[30:23];
    smaller_exponent = smaller[30:23] == 8'd0 ? 8'd1 : smaller[30:23];
    distance = larger_exponent - smaller_exponent;
  end

  logic [23:0] larger_q1, smaller_q1;
  logic [7:0] exponent_q1, distance_q1;
  logic opposite_q1, zero_sign_q1, sign_q1, infinite_q1, nan_q1;
  logic [1:0] round_q1;
  pipe_row #(
      .WIDTH(71),
      .DEPTH(REGISTERS_1)
  ) row_1 (
      .clk_i,
      .enable_i,
      .data_i({larger[30:23] != 8'd0, larger[22:0], smaller[30:23] != 8'd0, smaller[22:0], larger_exponent, distance,
               opposite, zero_sign, sign, infinite, nan, round_i}),
      .data_o({larger_q1, smaller_q1, exponent_q1, distance_q1, opposite_q1, zero_sign_q1, sign_q1, infinite_q1, nan_q1,
               round_q1})
  );

  // 2: the smaller one moved into place; the sum.
  logic [27:0] sum;
  align_add #(
      .WIDTH(24),
      .DISTANCE_BITS(8)
  ) align (
      .larger_i(larger_q1),
      .smaller_i(smaller_q1),
      .distance_i(distance_q1),
      .opposite_i(opposite_q1),
      .sum_o(sum)
  );

  logic [27:0] sum_q2;
  logic [7:0] exponent_q2;
  logic zero_sign_q2, sign_q2, infinite_q2, nan_q2;
  logic [1:0] round_q2;
  pipe_row #(
      .WIDTH(42),
      .DEPTH(REGISTERS_2)
  ) row_2 (
      .clk_i,
      .enable_i,
      .data_i({sum, exponent_q1, zero_sign_q1, sign_q1, infinite_q1, nan_q1, round_q1}),
      .data_o({sum_q2, exponent_q2, zero_sign_q2, sign_q2, infinite_q2, nan_q2, round_q2})
  );

  // 3: the highest one moved to the top, but not below exponent 1.
  logic [4:0] zeros, shift;
  logic [27:0] normal;
  logic [8:0] exponent;
  leading_zeros #(
      .WIDTH(32)
  ) count (
      .value_i({sum_q2, 4'd0}),
      .count_o(zeros)
  );
  always_comb begin
    shift = {3'd0, zeros} < exponent_q2 ? zeros : exponent_q2[4:0];
    normal = sum_q2 << shift;
    exponent = {1'b0, exponent_q2} + 9'd1 - {4'd0, shift};
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
      .data_i({normal[27:3], normal[2:0] != 3'd0, exponent, sum_q2 == 28'd0 ? zero_sign_q2 : sign_q2, infinite_q2,
               nan_q2, round_q2}),
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
