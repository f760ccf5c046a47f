// lane_rows: the rows that a lane's key reads, one for each pair of axes or one for all three.
//
//   combinational
//   twin    OnChipTables::reads (model/cull/on_chip_tables.h), but for dedup's second read and the compression LUT
`include "mask_designs.svh"

module lane_rows #(
    parameter int DESIGN = `CTU_DESIGN_PROJECTION,
    parameter int R_RAY = 4,
    parameter int ENTRIES = 0,
    parameter int ROWS = `CTU_ROWS_ALL,
    localparam int ROWS_OF_LANE = `CTU_ROWS_OF_LANE(DESIGN),
    localparam int ROW_BITS = $clog2(`CTU_KEY_ROWS(DESIGN, R_RAY, ENTRIES, ROWS)),
    localparam int AXES = DESIGN == `CTU_DESIGN_PROJECTION ? 2 : 3
) (
    input  logic [                     29:0] key_i,       // {end, begin}; of projections rows xy lowest, then yz, xz
    output logic [ROWS_OF_LANE*ROW_BITS-1:0] row_o,
    output logic [    ROWS_OF_LANE*AXES-1:0] mirrored_o,  // axes on which each row is to be mirrored
    output logic                             left_out_o   // there is no row
);
  wire [14:0] cells_begin = key_i[14:0];
  wire [14:0] cells_end = key_i[29:15];
  generate
    if (DESIGN == `CTU_DESIGN_PROJECTION) begin : g_pairs
      logic [2:0] no_row;
      assign left_out_o = |no_row;
      for (genvar pair = 0; pair < 3; pair++) begin : g_pair
        localparam int A = pair == 1 ? 1 : 0;  // xy, yz, xz
        localparam int B = pair == 0 ? 1 : 2;
        key_row #(
            .AXES(2),
            .R_RAY(R_RAY),
            .ROWS(ROWS),
            .ROW_BITS(ROW_BITS)
        ) number (
            .begin_i({cells_begin[5*B+:5], cells_begin[5*A+:5]}),
            .end_i({cells_end[5*B+:5], cells_end[5*A+:5]}),
            .row_o(row_o[ROW_BITS*pair+:ROW_BITS]),
            .mirrored_o(mirrored_o[2*pair+:2]),
            .left_out_o(no_row[pair])
        );
      end
    end else begin : g_key
      key_row #(
          .AXES(3),
          .R_RAY(R_RAY),
          .ROWS(ROWS),
          .MIRRORS(!`CTU_BIT_ROWS(DESIGN, ENTRIES)),
          .ROW_BITS(ROW_BITS)
      ) number (
          .begin_i(cells_begin),
          .end_i(cells_end),
          .row_o,
          .mirrored_o,
          .left_out_o
      );
    end
  endgenerate
endmodule
