// mask_lane: does the row that a lane has read share a cell with its object mask?
//
//   combinational
//   twin    ExecSource::passes (model/pipeline/exec_source.cpp); and_of_projections (model/cull/cell_bits.h)
//
// Of projections cell (x, y, z) is touched where all three rows say so; masks are touched cells by themselves; of a bit
// row the object mask's index picks the answer.
`include "mask_designs.svh"

module mask_lane #(
    parameter int DESIGN = `CTU_DESIGN_PROJECTION,
    parameter int R = 4,
    parameter bit BIT_ROWS = 1'b0,
    parameter int ROW_BITS = 48,
    parameter int OBJECT_BITS = 64
) (
    input  logic [   ROW_BITS-1:0] row_i,     // of projections xy lowest, then yz, xz
    input  logic [OBJECT_BITS-1:0] object_i,  // object mask; of bit rows its index
    output logic                   pass_o
);
  generate
    if (BIT_ROWS) begin : g_bit
      // The padding is what an index without an entry would pick.
      wire [(1 << OBJECT_BITS)-1:0] row = (1 << OBJECT_BITS)'(row_i);
      assign pass_o = row[object_i];
    end else begin : g_and
      logic [OBJECT_BITS-1:0] touched;
      if (DESIGN == `CTU_DESIGN_PROJECTION) begin : g_projections
        for (genvar z = 0; z < R; z++) begin : g_z
          for (genvar y = 0; y < R; y++) begin : g_y
            for (genvar x = 0; x < R; x++) begin : g_x
              assign touched[x+R*(y+R*z)] = row_i[x+R*y] && row_i[R*R+y+R*z] && row_i[2*R*R+x+R*z];
            end
          end
        end
      end else begin : g_mask
        assign touched = row_i;
      end
      assign pass_o = (touched & object_i) != '0;
    end
  endgenerate
endmodule
