// wide_to_float: a wide number (wide_format.svh) as binary32, rounded to nearest, ties to even; combinational.
//
//   twin    static_cast<float>(x) + 0.0f of model/intersect/sphere_test.cpp
//
// Arithmetic: subnormals and overflow to infinity as float_round says; what is zero, or too small for the smallest
// subnormal number, is +0.
`include "wide_format.svh"

module wide_to_float (
    input  logic [`WIDE_BITS-1:0] value_i,
    output logic [          31:0] result_o
);
  logic [9:0] bounded;
  narrow_exponent bound (
      .exponent_i({2'd0, value_i[`WIDE_EXPONENT]} - 13'd896),  // 1023 - 127
      .bounded_o (bounded)
  );
  logic [23:0] significand;
  logic guard, sticky;
  logic [8:0] exponent;
  subnormal_shift place (
      .digits_i({value_i[`WIDE_SIGNIFICAND], 1'b0}),
      .inexact_i(1'b0),
      .exponent_i(bounded),
      .significand_o(significand),
      .guard_o(guard),
      .sticky_o(sticky),
      .exponent_o(exponent)
  );
  logic [31:0] rounded;
  float_round round (
      .sign_i(value_i[`WIDE_SIGN]),
      .exponent_i(exponent),
      .significand_i(significand),
      .guard_i(guard),
      .sticky_i(sticky),
      .infinite_i(1'b0),
      .nan_i(1'b0),
      .round_i(2'd0),
      .result_o(rounded)
  );
  assign result_o = rounded[30:0] == 31'd0 ? 32'd0 : rounded;
endmodule
