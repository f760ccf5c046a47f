// What every float unit knows of binary32 and of rounding: the same numbers as ctu::numeric::Round and kCanonicalNan
// (model/numeric/round.h). Macros, because yosys 0.23 reads no package at a module's ports.
`ifndef CTU_FLOAT_FORMAT_SVH
`define CTU_FLOAT_FORMAT_SVH

`define FLOAT_ROUND_NEAREST 2'd0
`define FLOAT_ROUND_DOWN 2'd1
`define FLOAT_ROUND_UP 2'd2

`define FLOAT_CANONICAL_NAN 32'h7fc00000
`define FLOAT_PLUS_INFINITY 32'h7f800000
`define FLOAT_MINUS_INFINITY 32'hff800000

`endif
