// reverse_fold: the row of a key where a key and its reverse share one.
//
//   combinational
//   twin    ReverseFold::row (model/cull/key_fold.h)
//
// Each cell has a number c, inner cells first. Of a key's two cells the one with the larger number, l, and the other,
// s, give row l (l + 1) / 2 + s, less the rows left out: those of two inner cells.
`include "key_fold.svh"

module reverse_fold #(
    parameter int R_RAY = 4,
    parameter bit LEAVE_OUT_INNER = 1'b0,
    parameter int ROW_BITS = 12
) (
    input  logic [        14:0] begin_i,    // axis x lowest
    input  logic [        14:0] end_i,
    output logic [ROW_BITS-1:0] row_o,
    output logic                left_out_o
);
  localparam int INNER = (R_RAY - 2) * (R_RAY - 2) * (R_RAY - 2);  // cells
  localparam int LEFT_OUT = LEAVE_OUT_INNER ? `CTU_REVERSED_CLASSES(R_RAY - 2) : 0;
  localparam int WIDE_BITS = $clog2(`CTU_REVERSED_CLASSES(R_RAY));

  // Inner layers, rows or cells before a place.
  function automatic int inner_before(input int place);
    inner_before = place == 0 ? 0 : place == R_RAY - 1 ? R_RAY - 2 : place - 1;
  endfunction
  function automatic bit is_inner(input int place);
    is_inner = place > 0 && place < R_RAY - 1;
  endfunction

  function automatic logic [WIDE_BITS-1:0] number_of(input logic [14:0] place);
    int x, y, z, ahead;  // inner cells before this one
    x = {27'd0, place[4:0]};
    y = {27'd0, place[9:5]};
    z = {27'd0, place[14:10]};
    ahead = inner_before(z) * (R_RAY - 2) * (R_RAY - 2);
    if (is_inner(z)) ahead = ahead + inner_before(y) * (R_RAY - 2);
    if (is_inner(z) && is_inner(y)) ahead = ahead + inner_before(x);
    if (is_inner(x) && is_inner(y) && is_inner(z)) number_of = WIDE_BITS'(ahead);
    else number_of = WIDE_BITS'(INNER + x + R_RAY * (y + R_RAY * z) - ahead);
  endfunction

  logic [WIDE_BITS-1:0] from, to, larger, smaller, row;
  logic [WIDE_BITS:0] twice;
  always_comb begin
    from = number_of(begin_i);
    to = number_of(end_i);
    larger = from < to ? to : from;
    smaller = from < to ? from : to;
    twice = {1'b0, larger} * ({1'b0, larger} + (WIDE_BITS + 1)'(1));
    row = twice[WIDE_BITS:1] + smaller;
  end
  logic [WIDE_BITS-1:0] rest;
  assign {left_out_o, rest} = {1'b0, row} - (WIDE_BITS + 1)'(LEFT_OUT);
  assign row_o = ROW_BITS'(rest);
  wire unused_bits = &{1'b0, twice[0], rest};
endmodule
