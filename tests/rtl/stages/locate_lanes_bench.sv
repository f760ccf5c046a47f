// Lanes of cell_locate of several resolutions and latencies on the same inputs: R_RAY 4, 5, 6, 8 and R 4, 6. Where FEW are
// enough, only one key and one mask, of R_RAY and R 3, in the places of the second and the fifth.
module locate_lanes_bench #(
    parameter bit FEW = 1'b0
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] lo_i           [3],
    input  logic [31:0] hi_i           [3],
    input  logic [31:0] origin_i       [3],
    input  logic [ 2:0] zero_axes_i,
    input  logic [ 2:0] negative_axes_i,
    input  logic [31:0] near_down_i    [3],
    input  logic [31:0] near_up_i      [3],
    input  logic [31:0] far_down_i     [3],
    input  logic [31:0] far_up_i       [3],
    input  logic [31:0] t0_i,
    input  logic [31:0] t1_i,
    output logic [31:0] result_o       [13]  // keys of R_RAY 4, 5, 6, 8, mask of R 4 in two, of R 6 in seven words
);
  wire [95:0] lo = {lo_i[2], lo_i[1], lo_i[0]};
  wire [95:0] hi = {hi_i[2], hi_i[1], hi_i[0]};
  wire [95:0] origin = {origin_i[2], origin_i[1], origin_i[0]};
  wire [95:0] near_down = {near_down_i[2], near_down_i[1], near_down_i[0]};
  wire [95:0] near_up = {near_up_i[2], near_up_i[1], near_up_i[0]};
  wire [95:0] far_down = {far_down_i[2], far_down_i[1], far_down_i[0]};
  wire [95:0] far_up = {far_up_i[2], far_up_i[1], far_up_i[0]};

  generate
    for (genvar i = 0; i < 4; i++) begin : g_key
      if (!FEW || i == 1) begin : g_built
        logic [30:0] key;
        cell_locate_lane #(
            .R_RAY(FEW ? 3 : i == 3 ? 8 : 4 + i),
            .LATENCY(i == 0 ? 10 : i == 1 ? 0 : i == 2 ? 3 : 23)
        ) lane (
            .clk_i,
            .enable_i,
            .lo_i(lo),
            .hi_i(hi),
            .origin_i(origin),
            .zero_axes_i,
            .negative_axes_i,
            .near_down_i(near_down),
            .near_up_i(near_up),
            .far_down_i(far_down),
            .far_up_i(far_up),
            .t0_i,
            .t1_i,
            .key_o(key)
        );
        assign result_o[i] = {1'b0, key};
      end else begin : g_left_out
        assign result_o[i] = 32'd0;
      end
    end
    for (genvar i = 0; i < 2; i++) begin : g_mask
      localparam int R = FEW ? 3 : i == 0 ? 4 : 6;
      if (!FEW || i == 0) begin : g_built
        logic [R*R*R-1:0] mask;
        comparator_lane #(
            .R(R),
            .LATENCY(i == 0 ? 12 : 5)
        ) lane (
            .clk_i,
            .enable_i,
            .lo_i(lo),
            .hi_i(hi),
            .origin_i(origin),
            .zero_axes_i,
            .negative_axes_i,
            .near_down_i(near_down),
            .near_up_i(near_up),
            .far_down_i(far_down),
            .far_up_i(far_up),
            .t0_i,
            .t1_i,
            .mask_o(mask)
        );
        wire [223:0] words = 224'(mask);
        for (genvar word = 0; word < (i == 0 ? 2 : 7); word++) begin : g_word
          assign result_o[(i==0?4:6)+word] = words[32*word+:32];
        end
        wire unused_words = &{1'b0, words};
      end else begin : g_left_out
        for (genvar word = 0; word < 7; word++) begin : g_word
          assign result_o[6+word] = 32'd0;
        end
      end
    end
  endgenerate
endmodule
