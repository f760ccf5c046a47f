// float_key: a number that orders among its like, as unsigned, as the binary32 numbers do; combinational. Both zeros have
// the same one. Where many numbers are compared with many, each needs its key once and a comparison is one of integers.
//
//   twin    the comparisons < and == of C++ on binary32 that is no NaN; a NaN's key lies beyond an infinity's
module float_key (
    input  logic [31:0] a_i,
    output logic [31:0] key_o
);
  always_comb begin
    key_o = a_i[31] ? ~a_i : {1'b1, a_i[30:0]};
    if (a_i[30:0] == 31'd0) key_o = 32'h80000000;
`ifdef CTU_MUTATE_KEYS_OF_ZEROS
    key_o = a_i[31] ? ~a_i : {1'b1, a_i[30:0]};
`endif
  end
endmodule
