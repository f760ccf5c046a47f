// mask_lane: does the row that a lane has read share a cell with its object mask?
//
//   combinational
//   twin    ExecSource::passes (model/pipeline/exec_source.cpp); and_of_projections (model/cull/cell_bits.h)
//
// Of projections cell (x, y, z) is touched where all three rows say so; masks are touched cells by themselves; of a bit
// row the object mask's index picks the answer. Rows of folded tables are mirrored first.
`include "mask_designs.svh"

module mask_lane #(
    parameter int DESIGN = `CTU_DESIGN_PROJECTION,
    parameter int R = 4,
    parameter bit BIT_ROWS = 1'b0,
    parameter bit MIRRORS = 1'b0,
    parameter int MIRROR_BITS = 6,
    parameter int ROW_BITS = 48,
    parameter int OBJECT_BITS = 64
) (
    input  logic [   ROW_BITS-1:0] row_i,     // of projections xy lowest, then yz, xz
    input  logic [MIRROR_BITS-1:0] mirror_i,  // axes of a mask, or two axes of each projection
    input  logic [OBJECT_BITS-1:0] object_i,  // object mask; of bit rows its index
    output logic                   pass_o
);
  generate
    if (BIT_ROWS) begin : g_bit
      // The padding is what an index without an entry would pick.
      wire [(1 << OBJECT_BITS)-1:0] row = (1 << OBJECT_BITS)'(row_i);
      assign pass_o = row[object_i];
      wire unused_mirror = &{1'b0, mirror_i};
    end else begin : g_and
      logic [ROW_BITS-1:0] row;
      logic [OBJECT_BITS-1:0] touched;
      if (!MIRRORS) begin : g_as_read
        assign row = row_i;
        wire unused_mirror = &{1'b0, mirror_i};
      end else if (DESIGN == `CTU_DESIGN_PROJECTION) begin : g_mirrored_projections
        for (genvar pair = 0; pair < 3; pair++) begin : g_pair
          mask_mirror #(
              .R(R),
              .AXES(2)
          ) mirror (
              .mask_i(row_i[R*R*pair+:R*R]),
              .axes_i(mirror_i[2*pair+:2]),
              .mask_o(row[R*R*pair+:R*R])
          );
        end
      end else begin : g_mirrored_mask
        mask_mirror #(
            .R(R),
            .AXES(3)
        ) mirror (
            .mask_i(row_i),
            .axes_i(mirror_i),
            .mask_o(row)
        );
      end
      if (DESIGN == `CTU_DESIGN_PROJECTION) begin : g_projections
        for (genvar z = 0; z < R; z++) begin : g_z
          for (genvar y = 0; y < R; y++) begin : g_y
            for (genvar x = 0; x < R; x++) begin : g_x
              assign touched[x+R*(y+R*z)] = row[x+R*y] && row[R*R+y+R*z] && row[2*R*R+x+R*z];
            end
          end
        end
      end else begin : g_mask
        assign touched = row;
      end
      assign pass_o = (touched & object_i) != '0;
    end
  endgenerate
endmodule
