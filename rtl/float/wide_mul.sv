// wide_mul: a * b of wide numbers (wide_format.svh), rounded once.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    round24(a * b) of model/intersect/triangle_test.cpp
//
// Two steps: multiply; move by one place and round. The LATENCY registers are spread over the places behind them, the
// last place first.
`include "wide_format.svh"

module wide_mul #(
    parameter int LATENCY = 4
) (
    input  logic                  clk_i,
    input  logic                  enable_i,
    input  logic [`WIDE_BITS-1:0] a_i,
    input  logic [`WIDE_BITS-1:0] b_i,
    output logic [`WIDE_BITS-1:0] result_o
);
  // 1: the exact product of two significands that have their highest bit set, so that it has one of the highest two;
  // zero where one of them is.
  logic [47:0] product, product_q;
  logic [10:0] exponent, exponent_q;  // of a product in [1, 2)
  logic sign, sign_q;
  always_comb begin
    product = {24'd0, a_i[`WIDE_SIGNIFICAND]} * {24'd0, b_i[`WIDE_SIGNIFICAND]};
    exponent = a_i[`WIDE_EXPONENT] + b_i[`WIDE_EXPONENT] - 11'd1023;
    sign = a_i[`WIDE_SIGN] ^ b_i[`WIDE_SIGN];
  end
  pipe_row #(
      .WIDTH(60),
      .DEPTH(LATENCY / 2)
  ) row_1 (
      .clk_i,
      .enable_i,
      .data_i({sign, exponent, product}),
      .data_o({sign_q, exponent_q, product_q})
  );

  // 2: the highest one moved to the top, rounded and packed.
  logic [47:0] normal;
  logic sticky;
  logic [`WIDE_BITS-1:0] rounded;
  always_comb begin
    normal = product_q[47] ? product_q : {product_q[46:0], 1'b0};
    sticky = normal[22:0] != 23'd0;
`ifdef CTU_MUTATE_WIDE_PRODUCT_STICKY
    sticky = normal[22:1] != 22'd0;
`endif
  end
  wide_round round (
      .sign_i(sign_q),
      .exponent_i(exponent_q + {10'd0, product_q[47]}),
      .significand_i(normal[47:24]),
      .guard_i(normal[23]),
      .sticky_i(sticky),
      .result_o(rounded)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(LATENCY - LATENCY / 2)
  ) row_2 (
      .clk_i,
      .enable_i,
      .data_i(rounded),
      .data_o(result_o)
  );
endmodule
