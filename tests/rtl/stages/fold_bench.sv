// Each fold of keys for R_RAY 2 to LONGEST, on the same key: rows without and with those of inner cells left out, and
// of the projection on x and y.
module fold_bench #(
    parameter int LONGEST = 9
) (
    input  logic [29:0] key_i,                      // {end, begin}
    output logic [31:0] mirrored_row_o  [LONGEST+1][2],
    output logic [ 2:0] mirrored_o      [LONGEST+1][2],
    output logic        mirrored_left_o [LONGEST+1][2],
    output logic [31:0] reversed_row_o  [LONGEST+1][2],
    output logic        reversed_left_o [LONGEST+1][2],
    output logic [31:0] projected_row_o [LONGEST+1],
    output logic [ 1:0] projected_o     [LONGEST+1]
);
  generate
    for (genvar n = 2; n <= LONGEST; n++) begin : g_resolution
      for (genvar leave_out = 0; leave_out < 2; leave_out++) begin : g_rows
        mirror_fold #(
            .AXES(3),
            .R_RAY(n),
            .LEAVE_OUT_INNER(leave_out == 1),
            .ROW_BITS(20)
        ) mirror (
            .begin_i(key_i[14:0]),
            .end_i(key_i[29:15]),
            .row_o(mirrored_row_o[n][leave_out][19:0]),
            .mirrored_o(mirrored_o[n][leave_out]),
            .left_out_o(mirrored_left_o[n][leave_out])
        );
        assign mirrored_row_o[n][leave_out][31:20] = 12'd0;
        reverse_fold #(
            .R_RAY(n),
            .LEAVE_OUT_INNER(leave_out == 1),
            .ROW_BITS(20)
        ) reverse (
            .begin_i(key_i[14:0]),
            .end_i(key_i[29:15]),
            .row_o(reversed_row_o[n][leave_out][19:0]),
            .left_out_o(reversed_left_o[n][leave_out])
        );
        assign reversed_row_o[n][leave_out][31:20] = 12'd0;
      end
      logic unused_left;
      mirror_fold #(
          .AXES(2),
          .R_RAY(n),
          .ROW_BITS(20)
      ) project (
          .begin_i(key_i[9:0]),
          .end_i(key_i[24:15]),
          .row_o(projected_row_o[n][19:0]),
          .mirrored_o(projected_o[n]),
          .left_out_o(unused_left)
      );
      assign projected_row_o[n][31:20] = 12'd0;
    end
  endgenerate
endmodule
