// wide_from_float: a finite binary32 number as a wide one (wide_format.svh), exactly; combinational. Without NORMALISE
// subnormals and zeros keep binary32's form, which costs nothing and which only wide_add takes.
`include "wide_format.svh"

module wide_from_float #(
    parameter bit NORMALISE = 1'b1
) (
    input  logic [          31:0] value_i,
    output logic [`WIDE_BITS-1:0] result_o
);
  logic [ 7:0] exponent;
  logic [10:0] wide_exponent;
  logic [23:0] significand;
  always_comb begin
    significand = {value_i[30:23] != 8'd0, value_i[22:0]};
    // A subnormal has the exponent of the smallest normal numbers, and no hidden one.
    exponent = value_i[30:23] == 8'd0 ? 8'd1 : value_i[30:23];
    wide_exponent = {exponent[7], {3{~exponent[7]}}, exponent[6:0]};  // + 1023 - 127
  end

  generate
    if (NORMALISE) begin : g_normal
      logic [4:0] zeros;
      leading_zeros #(
          .WIDTH(32)
      ) count (
          .value_i({significand, 8'd0}),
          .count_o(zeros)
      );
      assign result_o = significand == 24'd0 ? '0
                                             : {value_i[31], wide_exponent - {6'd0, zeros}, significand << zeros};
    end else begin : g_as_it_is
      assign result_o = {value_i[31], wide_exponent, significand};
    end
  endgenerate
endmodule
