// float_round: the one place where a float unit's result is rounded, overflows and is packed; combinational.
//
// Arithmetic (model/numeric/round.h): IEEE 754 results in the direction of round_i (0 nearest, ties to even; 1 down;
// 2 up). A number is (-1)^sign * significand.guard,sticky * 2^(exponent - 127 - 23); a significand without its highest bit is
// subnormal, and exponent must be 1 then (or the significand, guard and sticky zero: a zero with the given sign).
// Subnormals are never flushed. Too large a number gives infinity, or the largest finite number where the direction
// points towards zero. Every NaN is 0x7fc00000.
`include "float_format.svh"

module float_round (
    input  logic        sign_i,
    input  logic [ 8:0] exponent_i,     // biased, 1 .. 511
    input  logic [23:0] significand_i,
    input  logic        guard_i,        // the bit below the significand
    input  logic        sticky_i,       // any bit below that one
    input  logic        infinite_i,     // the result is infinite with this sign, whatever the number
    input  logic        nan_i,          // the result is a NaN, whatever else
    input  logic [ 1:0] round_i,
    output logic [31:0] result_o
);
  logic away, to_infinity, overflow;
  logic [31:0] magnitude;  // exponent 9 bits, fraction 23

  // One more in the last place, away from zero.
  always_comb begin
    case (round_i)
      `FLOAT_ROUND_DOWN: away = sign_i & (guard_i | sticky_i);
      `FLOAT_ROUND_UP: away = ~sign_i & (guard_i | sticky_i);
      default: away = guard_i & (sticky_i | significand_i[0]);
    endcase
    case (round_i)
      `FLOAT_ROUND_DOWN: to_infinity = sign_i;
      `FLOAT_ROUND_UP: to_infinity = ~sign_i;
      default: to_infinity = 1'b1;
    endcase
`ifdef CTU_MUTATE_TIES_AWAY
    if (round_i == `FLOAT_ROUND_NEAREST) away = guard_i;
`endif
`ifdef CTU_MUTATE_DIRECTION_WITHOUT_SIGN
    if (round_i == `FLOAT_ROUND_UP) away = guard_i | sticky_i;
`endif
`ifdef CTU_MUTATE_OVERFLOW_TO_INFINITY
    to_infinity = 1'b1;
`endif
  end

  // The carry of a full fraction runs into the exponent, where it belongs: also from subnormal to normal and from the
  // largest finite number to infinity.
  always_comb begin
    magnitude = {significand_i[23] ? exponent_i : 9'd0, significand_i[22:0]} + {31'd0, away};
`ifdef CTU_MUTATE_FLUSH_SUBNORMALS
    if (!significand_i[23]) magnitude = '0;
`endif
    overflow = magnitude[31:23] >= 9'd255;
  end

  always_comb begin
    if (nan_i) result_o = `FLOAT_CANONICAL_NAN;
    else if (infinite_i || (overflow && to_infinity)) result_o = {sign_i, 8'hff, 23'h0};
    else if (overflow) result_o = {sign_i, 8'hfe, 23'h7fffff};
    else result_o = {sign_i, magnitude[30:0]};
`ifdef CTU_MUTATE_NAN_SIGN
    if (nan_i) result_o = {sign_i, 31'h7fc00000};
`endif
  end
endmodule
