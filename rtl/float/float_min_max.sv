// float_min_max: the smaller, or with max_i the larger, of two binary32 numbers; combinational.
//
//   twin    ctu::numeric::min and max (model/numeric/round.h)
//
// Arithmetic: of a NaN and a number the number, of two NaNs 0x7fc00000; -0 orders before +0.
`include "float_format.svh"

module float_min_max (
    input  logic [31:0] a_i,
    input  logic [31:0] b_i,
    input  logic        max_i,
    output logic [31:0] result_o
);
  logic [31:0] a_key, b_key;
  logic a_nan, b_nan, b_below;

  always_comb begin
    // As unsigned numbers the keys order as the numbers do, zeros by their sign.
    a_key = a_i[31] ? ~a_i : {1'b1, a_i[30:0]};
    b_key = b_i[31] ? ~b_i : {1'b1, b_i[30:0]};
    a_nan = a_i[30:0] > 31'h7f800000;
    b_nan = b_i[30:0] > 31'h7f800000;
    b_below = b_key < a_key;
`ifdef CTU_MUTATE_ZEROS_EQUAL
    if (a_i[30:0] == 31'd0 && b_i[30:0] == 31'd0) b_below = 1'b0;
`endif
    if (a_nan && b_nan) result_o = `FLOAT_CANONICAL_NAN;
    else if (a_nan) result_o = b_i;
    else if (b_nan) result_o = a_i;
    else result_o = b_below != max_i ? b_i : a_i;
  end
endmodule
