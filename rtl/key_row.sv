// key_row: the row of a table that a key reads.
//
//   combinational
//   twin    OnChipTables::row_of and row_of_pair (model/cull/on_chip_tables.h)
//
// AXES 3: the whole key; 2: its projection on a pair of axes. Each cell of begin and end has 5 bits an axis, the first
// axis lowest. With a row for every key: begin of the first axis fastest, begins of the others, then the ends. Else
// mirror_fold where rows are masks, reverse_fold where they are bit rows.
`include "mask_designs.svh"

module key_row #(
    parameter int AXES = 3,
    parameter int R_RAY = 4,
    parameter int ROWS = `CTU_ROWS_ALL,
    parameter bit MIRRORS = 1'b1,  // rows are masks
    parameter int ROW_BITS = 12
) (
    input  logic [  5*AXES-1:0] begin_i,
    input  logic [  5*AXES-1:0] end_i,
    output logic [ROW_BITS-1:0] row_o,
    output logic [    AXES-1:0] mirrored_o,  // axes on which the row is to be mirrored
    output logic                left_out_o   // there is no row
);
  generate
    if (ROWS == `CTU_ROWS_ALL) begin : g_all
      always_comb begin
        row_o = '0;
        for (int axis = AXES - 1; axis >= 0; axis--) row_o = ROW_BITS'(row_o * R_RAY) + ROW_BITS'(end_i[5*axis+:5]);
        for (int axis = AXES - 1; axis >= 0; axis--) row_o = ROW_BITS'(row_o * R_RAY) + ROW_BITS'(begin_i[5*axis+:5]);
      end
      assign mirrored_o = '0;
      assign left_out_o = 1'b0;
    end else if (MIRRORS) begin : g_mirror
      // A projection does not see the axis on which a ray enters, so none of its rows is out of reach.
      mirror_fold #(
          .AXES(AXES),
          .R_RAY(R_RAY),
          .LEAVE_OUT_INNER(ROWS == `CTU_ROWS_REACHABLE && AXES == 3),
          .ROW_BITS(ROW_BITS)
      ) fold (
          .begin_i,
          .end_i,
          .row_o,
          .mirrored_o,
          .left_out_o
      );
    end else begin : g_reverse
      reverse_fold #(
          .R_RAY(R_RAY),
          .LEAVE_OUT_INNER(ROWS == `CTU_ROWS_REACHABLE),
          .ROW_BITS(ROW_BITS)
      ) fold (
          .begin_i,
          .end_i,
          .row_o,
          .left_out_o
      );
      assign mirrored_o = '0;
    end
  endgenerate
endmodule
