// float_fraction: a * K / N of binary32, 0 < K < N <= 24, rounded outwards: down, or up where UP is set.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    one product of ctu::cull::lerp_planes with the weights of make_weights (model/cull/plane_times.{h,cpp})
//
// Arithmetic: the product of a and a weight, exactly rounded in the direction of UP, as numeric::mul gives it. The weight
// is K / N where that is a binary32 number, else the neighbour that moves the product outwards: of a lower bound the one
// below for a >= 0 and the one above for a < 0, of an upper bound the other way round. Subnormals as any number;
// infinity stays, NaN operands give 0x7fc00000. Three steps: multiply, place, round; the LATENCY registers are spread over
// the places behind each of them, the last place first.
//
// A float_mul with a constant operand gives the same bits. This one is smaller: a constant's bits leave few rows to add,
// and as a weight is normal, lies in [1/32, 1) and moves the exponent by PLACES at most, the product moves by 5 places at most.
`include "float_format.svh"

module float_fraction #(
    parameter int K = 1,
    parameter int N = 2,
    parameter bit UP = 1'b0,
    parameter int LATENCY = 3
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] a_i,
    output logic [31:0] result_o
);
  // Registers behind the three steps.
  localparam int REGISTERS_1 = LATENCY / 3;
  localparam int REGISTERS_2 = 2 * LATENCY / 3 - LATENCY / 3;
  localparam int REGISTERS_3 = LATENCY - 2 * LATENCY / 3;

  // K / N = significand / 2^(23 + PLACES) with the significand in [2^23, 2^24). SIGNIFICAND is that of the weight below;
  // the weight above has the next one and never the next exponent: K 2^PLACES / N is 2 - 1/24 at most.
  localparam int PLACES = 2 * K >= N ? 1 : 4 * K >= N ? 2 : 8 * K >= N ? 3 : 16 * K >= N ? 4 : 5;
  localparam int SIGNIFICAND = (K << (PLACES + 23)) / N;
  localparam bit EXACT = SIGNIFICAND * N == K << (PLACES + 23);

  // 1: the exact product of the significands; with the weight above once more that of a.
  logic [23:0] significand;
  logic [47:0] product;
  logic above;
  always_comb begin
    significand = {a_i[30:23] != 8'd0, a_i[22:0]};
    above = !EXACT && a_i[31] != UP;
`ifdef CTU_MUTATE_WEIGHT_INWARDS
    above = !EXACT && UP;
`endif
    product = {24'd0, significand} * 48'(SIGNIFICAND) + (above ? {24'd0, significand} : 48'd0);
  end

  logic [47:0] product_q1;
  logic [7:0] exponent_q1;
  logic sign_q1, infinite_q1, nan_q1;
  pipe_row #(
      .WIDTH(59),
      .DEPTH(REGISTERS_1)
  ) row_1 (
      .clk_i,
      .enable_i,
      // A subnormal has the exponent of the smallest normal numbers.
      .data_i({product, a_i[30:23] == 8'd0 ? 8'd1 : a_i[30:23], a_i[31], a_i[30:0] == 31'h7f800000,
               a_i[30:0] > 31'h7f800000}),
      .data_o({product_q1, exponent_q1, sign_q1, infinite_q1, nan_q1})
  );

  // 2: the product's significand from place 23 up when it moves by 0. It moves down by one where it has 48 places, or until
  // the exponent is 1. A subnormal's moves by PLACES: it never has its highest place.
  logic [2:0] shift;
  logic [52:0] placed;
  logic [7:0] exponent;
  always_comb begin
    shift = {2'd0, product_q1[47]};
    if (exponent_q1 <= 8'(PLACES)) shift = 3'(8'(PLACES) + 8'd1 - exponent_q1);
    placed = {product_q1, 5'd0} >> shift;
    exponent = exponent_q1 + {5'd0, shift} - 8'(PLACES);
  end
  wire unused_top = placed[52];  // zero: a product of 48 places has moved

  logic [23:0] significand_q2;
  logic [7:0] exponent_q2;
  logic guard_q2, sticky_q2, sign_q2, infinite_q2, nan_q2;
  pipe_row #(
      .WIDTH(37),
      .DEPTH(REGISTERS_2)
  ) row_2 (
      .clk_i,
      .enable_i,
`ifdef CTU_MUTATE_FRACTION_STICKY
      .data_i({placed[51:27], 1'b0, exponent, sign_q1, infinite_q1, nan_q1}),
`else
      .data_i({placed[51:27], placed[26:0] != 27'd0, exponent, sign_q1, infinite_q1, nan_q1}),
`endif
      .data_o({significand_q2, guard_q2, sticky_q2, exponent_q2, sign_q2, infinite_q2, nan_q2})
  );

  // 3: rounded and packed.
  float_finish #(
      .LATENCY(REGISTERS_3)
  ) finish (
      .clk_i,
      .enable_i,
      .sign_i(sign_q2),
      .exponent_i({1'b0, exponent_q2}),
      .significand_i(significand_q2),
      .guard_i(guard_q2),
      .sticky_i(sticky_q2),
      .infinite_i(infinite_q2),
      .nan_i(nan_q2),
      .round_i(UP ? `FLOAT_ROUND_UP : `FLOAT_ROUND_DOWN),
      .result_o
  );
endmodule
