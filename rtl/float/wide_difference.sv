// wide_difference: a * b - c * d of wide numbers (wide_format.svh): both products exact, their difference rounded once,
// so that its sign is exact and only equal products give zero.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    round24_difference(a * b, c * d) of model/intersect/triangle_test.cpp
//
// Five steps: multiply, order, subtract, normalise, round; the LATENCY registers are spread over the places behind each
// of them, the last place first.
`include "wide_format.svh"

module wide_difference #(
    parameter int LATENCY = 8
) (
    input  logic                  clk_i,
    input  logic                  enable_i,
    input  logic [`WIDE_BITS-1:0] a_i,
    input  logic [`WIDE_BITS-1:0] b_i,
    input  logic [`WIDE_BITS-1:0] c_i,
    input  logic [`WIDE_BITS-1:0] d_i,
    output logic [`WIDE_BITS-1:0] result_o
);
  // Registers behind the five steps.
  localparam int REGISTERS_1 = LATENCY / 5;
  localparam int REGISTERS_2 = 2 * LATENCY / 5 - LATENCY / 5;
  localparam int REGISTERS_3 = 3 * LATENCY / 5 - 2 * LATENCY / 5;
  localparam int REGISTERS_4 = 4 * LATENCY / 5 - 3 * LATENCY / 5;
  localparam int REGISTERS_5 = LATENCY - 4 * LATENCY / 5;

  // 1: the exact products, each with one of its highest two bits set or zero, and the exponents of products in [1, 2).
  logic [47:0] first, first_q1, second, second_q1;
  logic [10:0] first_exponent, first_exponent_q1, second_exponent, second_exponent_q1;
  logic first_sign, first_sign_q1, second_sign, second_sign_q1;
  always_comb begin
    first = {24'd0, a_i[`WIDE_SIGNIFICAND]} * {24'd0, b_i[`WIDE_SIGNIFICAND]};
    second = {24'd0, c_i[`WIDE_SIGNIFICAND]} * {24'd0, d_i[`WIDE_SIGNIFICAND]};
    first_exponent = a_i[`WIDE_EXPONENT] + b_i[`WIDE_EXPONENT] - 11'd1023;
    second_exponent = c_i[`WIDE_EXPONENT] + d_i[`WIDE_EXPONENT] - 11'd1023;
    first_sign = a_i[`WIDE_SIGN] ^ b_i[`WIDE_SIGN];
    second_sign = ~(c_i[`WIDE_SIGN] ^ d_i[`WIDE_SIGN]);  // of what is added
  end
  pipe_row #(
      .WIDTH(120),
      .DEPTH(REGISTERS_1)
  ) row_1 (
      .clk_i,
      .enable_i,
      .data_i({first_sign, first_exponent, first, second_sign, second_exponent, second}),
      .data_o({first_sign_q1, first_exponent_q1, first_q1, second_sign_q1, second_exponent_q1, second_q1})
  );

  // 2: their highest ones moved to the top, zero given the smallest exponent; the larger one first.
  logic [58:0] first_magnitude, second_magnitude, larger, smaller;
  logic [10:0] distance;
  logic sign, opposite;
  always_comb begin
    first_magnitude = {first_exponent_q1 + {10'd0, first_q1[47]}, first_q1[47] ? first_q1 : {first_q1[46:0], 1'b0}};
    second_magnitude = {
      second_exponent_q1 + {10'd0, second_q1[47]}, second_q1[47] ? second_q1 : {second_q1[46:0], 1'b0}
    };
    if (!first_magnitude[47]) first_magnitude = '0;
    if (!second_magnitude[47]) second_magnitude = '0;
    opposite = first_sign_q1 != second_sign_q1;
    larger = first_magnitude;
    smaller = second_magnitude;
    sign = first_sign_q1;
    if (first_magnitude < second_magnitude) begin
      larger = second_magnitude;
      smaller = first_magnitude;
      sign = second_sign_q1;
    end
    distance = larger[58:48] - smaller[58:48];
  end

  logic [58:0] larger_q2;
  logic [47:0] smaller_q2;
  logic [10:0] distance_q2;
  logic sign_q2, opposite_q2;
  pipe_row #(
      .WIDTH(120),
      .DEPTH(REGISTERS_2)
  ) row_2 (
      .clk_i,
      .enable_i,
      .data_i({sign, larger, smaller[47:0], distance, opposite}),
      .data_o({sign_q2, larger_q2, smaller_q2, distance_q2, opposite_q2})
  );

  // 3: the sum of the signed products.
  logic [51:0] sum, sum_q3;
  logic [10:0] exponent_q3;
  logic sign_q3;
  align_add #(
      .WIDTH(48),
      .DISTANCE_BITS(11)
  ) align (
      .larger_i(larger_q2[47:0]),
      .smaller_i(smaller_q2),
      .distance_i(distance_q2),
      .opposite_i(opposite_q2),
      .sum_o(sum)
  );
  pipe_row #(
      .WIDTH(64),
      .DEPTH(REGISTERS_3)
  ) row_3 (
      .clk_i,
      .enable_i,
      .data_i({sign_q2, larger_q2[58:48], sum}),
      .data_o({sign_q3, exponent_q3, sum_q3})
  );

  // 4: the highest one moved to the top.
  logic [5:0] zeros;
  logic [51:0] normal;
  logic [10:0] exponent, exponent_q4;
  logic [23:0] significand_q4;
  logic sticky, sign_q4, guard_q4, sticky_q4;
  leading_zeros #(
      .WIDTH(64)
  ) count (
      .value_i({sum_q3, 12'd0}),
      .count_o(zeros)
  );
  always_comb begin
    normal = sum_q3 << zeros;
    exponent = exponent_q3 + 11'd1 - {5'd0, zeros};
    sticky = normal[26:0] != 27'd0;
`ifdef CTU_MUTATE_WIDE_DIFFERENCE_STICKY
    sticky = normal[26:3] != 24'd0;
`endif
  end
  pipe_row #(
      .WIDTH(38),
      .DEPTH(REGISTERS_4)
  ) row_4 (
      .clk_i,
      .enable_i,
      .data_i({sign_q3, exponent, normal[51:27], sticky}),
      .data_o({sign_q4, exponent_q4, significand_q4, guard_q4, sticky_q4})
  );

  // 5: rounded and packed.
  logic [`WIDE_BITS-1:0] rounded;
  wide_round round (
      .sign_i(sign_q4),
      .exponent_i(exponent_q4),
      .significand_i(significand_q4),
      .guard_i(guard_q4),
      .sticky_i(sticky_q4),
      .result_o(rounded)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(REGISTERS_5)
  ) row_5 (
      .clk_i,
      .enable_i,
      .data_i(rounded),
      .data_o(result_o)
  );
endmodule
