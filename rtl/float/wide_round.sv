// wide_round: the one place where a wide number (wide_format.svh) is rounded, to nearest, ties to even, and packed;
// combinational. The significand has its highest bit set, or the number is zero.
`include "wide_format.svh"

module wide_round (
    input  logic                  sign_i,
    input  logic [          10:0] exponent_i,
    input  logic [          23:0] significand_i,
    input  logic                  guard_i,        // the bit below the significand
    input  logic                  sticky_i,       // any bit below that one
    output logic [`WIDE_BITS-1:0] result_o
);
  logic away;
  logic [33:0] magnitude;  // exponent, and the significand without its highest bit: a carry runs from one to the other
  always_comb begin
    away = guard_i & (sticky_i | significand_i[0]);
`ifdef CTU_MUTATE_WIDE_TIES_AWAY
    away = guard_i;
`endif
    magnitude = {exponent_i, significand_i[22:0]} + {33'd0, away};
    result_o = significand_i[23] ? {sign_i, magnitude[33:23], 1'b1, magnitude[22:0]} : '0;
  end
endmodule
