// float_div: a / b of binary32, exactly rounded in all three directions at once: the digits are the expensive part, and a
// ray needs its reciprocals rounded both down and up.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    ctu::numeric::div (model/numeric/round.h)
//
// Arithmetic: subnormals as any number; 0 / 0, infinity / infinity and NaN operands give 0x7fc00000; a number / 0 is
// infinite; signs as IEEE 754; overflow as float_round says. Normalises the operands; all steps and registers are those
// of float_quotient.
module float_div #(
    parameter int LATENCY = 16
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] a_i,
    input  logic [31:0] b_i,
    output logic [31:0] nearest_o,
    output logic [31:0] down_o,
    output logic [31:0] up_o
);
  // Both significands with their highest one on top. The exponent is biased, and may lie outside of what a number can
  // have.
  logic [4:0] a_zeros, b_zeros;
  leading_zeros #(
      .WIDTH(32)
  ) count_a (
      .value_i({a_i[30:23] != 8'd0, a_i[22:0], 8'd0}),
      .count_o(a_zeros)
  );
  leading_zeros #(
      .WIDTH(32)
  ) count_b (
      .value_i({b_i[30:23] != 8'd0, b_i[22:0], 8'd0}),
      .count_o(b_zeros)
  );

  logic [23:0] a_normal, b_normal;
  logic [9:0] exponent;  // two's complement, -149 .. 403
  logic zero, infinite, nan;
  logic a_zero, b_zero, a_infinite, b_infinite;
  always_comb begin
    a_normal = {a_i[30:23] != 8'd0, a_i[22:0]} << a_zeros;
    b_normal = {b_i[30:23] != 8'd0, b_i[22:0]} << b_zeros;
    // A subnormal has the exponent of the smallest normal numbers, and no hidden one.
    exponent = {2'd0, a_i[30:24], a_i[23] | (a_i[30:23] == 8'd0)} - {5'd0, a_zeros} -
               {2'd0, b_i[30:24], b_i[23] | (b_i[30:23] == 8'd0)} + {5'd0, b_zeros} + 10'd127;
    a_zero = a_i[30:0] == 31'd0;
    b_zero = b_i[30:0] == 31'd0;
    a_infinite = a_i[30:0] == 31'h7f800000;
    b_infinite = b_i[30:0] == 31'h7f800000;
    zero = a_zero || b_infinite;
    infinite = a_infinite || b_zero;
    nan = a_i[30:0] > 31'h7f800000 || b_i[30:0] > 31'h7f800000 || (zero && infinite);
  end

  float_quotient #(
      .LATENCY(LATENCY)
  ) divide (
      .clk_i,
      .enable_i,
      .a_i(a_normal),
      .b_i(b_normal),
      .exponent_i(exponent),
      .sign_i(a_i[31] ^ b_i[31]),
      .zero_i(zero),
      .infinite_i(infinite),
      .nan_i(nan),
      .nearest_o,
      .down_o,
      .up_o
  );
endmodule
