// float_compare: how two binary32 numbers order; combinational. With a NaN all are false but unordered_o.
//
//   twin    the comparisons < and == of C++ on binary32, as model/numeric/round.h defines them
module float_compare (
    input  logic [31:0] a_i,
    input  logic [31:0] b_i,
    output logic        less_o,
    output logic        equal_o,      // the zeros are equal, whatever their signs
    output logic        unordered_o
);
  logic both_zero, below;

  always_comb begin
    unordered_o = a_i[30:0] > 31'h7f800000 || b_i[30:0] > 31'h7f800000;
    both_zero = a_i[30:0] == 31'd0 && b_i[30:0] == 31'd0;
    below = (a_i[31] ? ~a_i : {1'b1, a_i[30:0]}) < (b_i[31] ? ~b_i : {1'b1, b_i[30:0]});
    equal_o = !unordered_o && (both_zero || a_i == b_i);
    less_o = !unordered_o && !both_zero && below;
`ifdef CTU_MUTATE_ZEROS_ORDERED
    less_o = !unordered_o && below;
`endif
  end
endmodule
