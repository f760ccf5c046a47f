// wide_add: a + b, or a - b, of wide numbers (wide_format.svh), rounded once.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    round24(a + b) and round24(a - b) of model/intersect/triangle_test.cpp
//
// The steps of float_add: order, add, normalise, round; the LATENCY registers are spread over the places behind each of
// them, the last place first.
`include "wide_format.svh"

module wide_add #(
    parameter int LATENCY = 4
) (
    input  logic                  clk_i,
    input  logic                  enable_i,
    input  logic [`WIDE_BITS-1:0] a_i,
    input  logic [`WIDE_BITS-1:0] b_i,
    input  logic                  subtract_i,
    output logic [`WIDE_BITS-1:0] result_o
);
  // Registers behind the four steps.
  localparam int REGISTERS_1 = LATENCY / 4;
  localparam int REGISTERS_2 = 2 * LATENCY / 4 - LATENCY / 4;
  localparam int REGISTERS_3 = 3 * LATENCY / 4 - 2 * LATENCY / 4;
  localparam int REGISTERS_4 = LATENCY - 3 * LATENCY / 4;

  // 1: the operand of larger magnitude first, and how far the other one must move.
  logic [`WIDE_BITS-1:0] larger, smaller;
  logic opposite;
  logic [10:0] distance;
  always_comb begin
    larger = a_i;
    smaller = {b_i[`WIDE_SIGN] ^ subtract_i, b_i[`WIDE_SIGN-1:0]};
    opposite = larger[`WIDE_SIGN] != smaller[`WIDE_SIGN];
    if (a_i[`WIDE_SIGN-1:0] < b_i[`WIDE_SIGN-1:0]) begin
      larger = {b_i[`WIDE_SIGN] ^ subtract_i, b_i[`WIDE_SIGN-1:0]};
      smaller = a_i;
    end
    distance = larger[`WIDE_EXPONENT] - smaller[`WIDE_EXPONENT];
  end

  logic [`WIDE_BITS-1:0] larger_q1;
  logic [23:0] smaller_q1;
  logic [10:0] distance_q1;
  logic opposite_q1;
  pipe_row #(
      .WIDTH(`WIDE_BITS + 36),
      .DEPTH(REGISTERS_1)
  ) row_1 (
      .clk_i,
      .enable_i,
      .data_i({larger, smaller[`WIDE_SIGNIFICAND], distance, opposite}),
      .data_o({larger_q1, smaller_q1, distance_q1, opposite_q1})
  );

  // 2: the sum.
  logic [27:0] sum, sum_q2;
  align_add #(
      .WIDTH(24),
      .DISTANCE_BITS(11)
  ) align (
      .larger_i(larger_q1[`WIDE_SIGNIFICAND]),
      .smaller_i(smaller_q1),
      .distance_i(distance_q1),
      .opposite_i(opposite_q1),
      .sum_o(sum)
  );

  logic sign_q2;
  logic [10:0] exponent_q2;
  pipe_row #(
      .WIDTH(40),
      .DEPTH(REGISTERS_2)
  ) row_2 (
      .clk_i,
      .enable_i,
      .data_i({larger_q1[`WIDE_SIGN], larger_q1[`WIDE_EXPONENT], sum}),
      .data_o({sign_q2, exponent_q2, sum_q2})
  );

  // 3: the highest one moved to the top.
  logic [4:0] zeros;
  logic [27:0] normal;
  logic [10:0] exponent;
  leading_zeros #(
      .WIDTH(32)
  ) count (
      .value_i({sum_q2, 4'd0}),
      .count_o(zeros)
  );
  always_comb begin
    normal = sum_q2 << zeros;
    exponent = exponent_q2 + 11'd1 - {6'd0, zeros};
  end

  logic sign_q3, guard_q3, sticky_q3;
  logic [10:0] exponent_q3;
  logic [23:0] significand_q3;
  pipe_row #(
      .WIDTH(38),
      .DEPTH(REGISTERS_3)
  ) row_3 (
      .clk_i,
      .enable_i,
      .data_i({sign_q2, exponent, normal[27:3], normal[2:0] != 3'd0}),
      .data_o({sign_q3, exponent_q3, significand_q3, guard_q3, sticky_q3})
  );

  // 4: rounded and packed.
  logic [`WIDE_BITS-1:0] rounded;
  wide_round round (
      .sign_i(sign_q3),
      .exponent_i(exponent_q3),
      .significand_i(significand_q3),
      .guard_i(guard_q3),
      .sticky_i(sticky_q3),
      .result_o(rounded)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(REGISTERS_4)
  ) row_4 (
      .clk_i,
      .enable_i,
      .data_i(rounded),
      .data_o(result_o)
  );
endmodule
