// wide_div: a / b of wide numbers (wide_format.svh) as binary32, rounded once, to nearest, ties to even.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    quotient(a, b) of model/intersect/triangle_test.cpp
//
// Arithmetic: subnormals and overflow to infinity as float_round says; every quotient that is zero, or too small for
// the smallest subnormal, is +0. b is not zero (if it is, the result says nothing). All steps and registers are those of
// float_quotient.
`include "wide_format.svh"

module wide_div #(
    parameter int LATENCY = 16
) (
    input  logic                  clk_i,
    input  logic                  enable_i,
    input  logic [`WIDE_BITS-1:0] a_i,
    input  logic [`WIDE_BITS-1:0] b_i,
    output logic [          31:0] result_o
);
  logic [9:0] bounded;
  narrow_exponent bound (
      .exponent_i({2'd0, a_i[`WIDE_EXPONENT]} - {2'd0, b_i[`WIDE_EXPONENT]} + 13'd127),
      .bounded_o (bounded)
  );

  logic [31:0] quotient;
  logic [63:0] unused_directed;
  float_quotient #(
      .LATENCY (LATENCY),
      .DIRECTED(1'b0)
  ) divide (
      .clk_i,
      .enable_i,
      .a_i(a_i[`WIDE_SIGNIFICAND]),
      .b_i(b_i[`WIDE_SIGNIFICAND]),
      .exponent_i(bounded),
      .sign_i(a_i[`WIDE_SIGN] ^ b_i[`WIDE_SIGN]),
      .zero_i(!a_i[`WIDE_NOT_ZERO]),
      .infinite_i(1'b0),
      .nan_i(1'b0),
      .nearest_o(quotient),
      .down_o(unused_directed[31:0]),
      .up_o(unused_directed[63:32])
  );
`ifdef CTU_MUTATE_WIDE_ZERO_SIGN
  assign result_o = quotient;
`else
  assign result_o = quotient[30:0] == 31'd0 ? 32'd0 : quotient;
`endif
endmodule
