// key_row: the row of a table that a key reads.
//
//   combinational
//   twin    OnChipTables::row_of and row_of_pair (model/cull/on_chip_tables.h)
//
// AXES 3: the whole key; 2: its projection on a pair of axes. Each cell of begin and end has 5 bits an axis, the first
// axis lowest. Row: begin of the first axis fastest, begins of the others, then the ends.
module key_row #(
    parameter int AXES = 3,
    parameter int R_RAY = 4,
    parameter int ROW_BITS = 12
) (
    input  logic [5*AXES-1:0] begin_i,
    input  logic [5*AXES-1:0] end_i,
    output logic [ROW_BITS-1:0] row_o
);
  always_comb begin
    row_o = '0;
    for (int axis = AXES - 1; axis >= 0; axis--) row_o = ROW_BITS'(row_o * R_RAY) + ROW_BITS'(end_i[5*axis+:5]);
    for (int axis = AXES - 1; axis >= 0; axis--) row_o = ROW_BITS'(row_o * R_RAY) + ROW_BITS'(begin_i[5*axis+:5]);
  end
endmodule
