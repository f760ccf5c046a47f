// narrow_exponent: the exponent of a wide number or a quotient of two as the divider and float_round take it;
// combinational. Above 2^128 the number overflows and below 2^-254 it is zero, by however much.
module narrow_exponent (
    input  logic [12:0] exponent_i,  // two's complement, biased by 127
    output logic [ 9:0] bounded_o    // the same, or -128 or 256 in its place
);
  always_comb begin
    if (exponent_i[12]) bounded_o = exponent_i[11:7] == 5'h1f ? exponent_i[9:0] : 10'h380;  // -128
    else bounded_o = exponent_i[11:8] == 4'd0 ? exponent_i[9:0] : 10'd256;
`ifdef CTU_MUTATE_WIDE_QUOTIENT_WRAPS
    bounded_o = exponent_i[9:0];
`endif
  end
endmodule
