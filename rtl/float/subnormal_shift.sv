// subnormal_shift: moves the digits of a number below binary32's smallest normal one down to exponent 1, as float_round
// wants them; combinational. Numbers above keep theirs.
module subnormal_shift (
    input  logic [24:0] digits_i,    // in [1, 2), the lowest one the guard bit
    input  logic        inexact_i,   // something lies below them
    input  logic [ 9:0] exponent_i,  // two's complement, biased by 127
    output logic [23:0] significand_o,
    output logic        guard_o,
    output logic        sticky_o,
    output logic [ 8:0] exponent_o
);
  logic subnormal;
  logic [9:0] below;
  logic [4:0] shift;
  always_comb begin
    subnormal = exponent_i[9] || exponent_i == 10'd0;
    below = 10'd1 - exponent_i;
    shift = !subnormal ? 5'd0 : below > 10'd31 ? 5'd31 : below[4:0];
    {significand_o, guard_o} = digits_i >> shift;
    sticky_o = inexact_i || (digits_i & ~({25{1'b1}} << shift)) != '0;
`ifdef CTU_MUTATE_QUOTIENT_STICKY
    sticky_o = (digits_i & ~({25{1'b1}} << shift)) != '0;
`endif
    exponent_o = subnormal ? 9'd1 : exponent_i[8:0];
  end
endmodule
