// A lane of the box test as docs/unit.md times it, with the inner bounds and without, on the same inputs.
module lane_bench (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] lo_i           [3],
    input  logic [31:0] hi_i           [3],
    input  logic [31:0] origin_i       [3],
    input  logic [31:0] rcp_down_i     [3],
    input  logic [31:0] rcp_up_i       [3],
    input  logic [ 2:0] zero_axes_i,
    input  logic [ 2:0] negative_axes_i,
    input  logic [31:0] tmin_i,
    input  logic [31:0] tmax_i,
    output logic [31:0] near_down_o    [3],
    output logic [31:0] near_up_o      [3],
    output logic [31:0] far_down_o     [3],
    output logic [31:0] far_up_o       [3],
    output logic [31:0] t0_o,
    output logic [31:0] t1_o,
    output logic        hit_o,
    output logic [31:0] outer_t0_o,
    output logic [31:0] outer_t1_o,
    output logic        outer_hit_o
);
  logic [95:0] near_down, near_up, far_down, far_up;
  assign near_down_o = '{near_down[31:0], near_down[63:32], near_down[95:64]};
  assign near_up_o = '{near_up[31:0], near_up[63:32], near_up[95:64]};
  assign far_down_o = '{far_down[31:0], far_down[63:32], far_down[95:64]};
  assign far_up_o = '{far_up[31:0], far_up[63:32], far_up[95:64]};

  box_test_lane lane (
      .clk_i,
      .enable_i,
      .lo_i({lo_i[2], lo_i[1], lo_i[0]}),
      .hi_i({hi_i[2], hi_i[1], hi_i[0]}),
      .origin_i({origin_i[2], origin_i[1], origin_i[0]}),
      .rcp_down_i({rcp_down_i[2], rcp_down_i[1], rcp_down_i[0]}),
      .rcp_up_i({rcp_up_i[2], rcp_up_i[1], rcp_up_i[0]}),
      .zero_axes_i,
      .negative_axes_i,
      .tmin_i,
      .tmax_i,
      .near_down_o(near_down),
      .near_up_o(near_up),
      .far_down_o(far_down),
      .far_up_o(far_up),
      .t0_o,
      .t1_o,
      .hit_o
  );

  logic [383:0] unused_bounds;
  box_test_lane #(
      .INNER(1'b0)
  ) outer_lane (
      .clk_i,
      .enable_i,
      .lo_i({lo_i[2], lo_i[1], lo_i[0]}),
      .hi_i({hi_i[2], hi_i[1], hi_i[0]}),
      .origin_i({origin_i[2], origin_i[1], origin_i[0]}),
      .rcp_down_i({rcp_down_i[2], rcp_down_i[1], rcp_down_i[0]}),
      .rcp_up_i({rcp_up_i[2], rcp_up_i[1], rcp_up_i[0]}),
      .zero_axes_i,
      .negative_axes_i,
      .tmin_i,
      .tmax_i,
      .near_down_o(unused_bounds[95:0]),
      .near_up_o(unused_bounds[191:96]),
      .far_down_o(unused_bounds[287:192]),
      .far_up_o(unused_bounds[383:288]),
      .t0_o(outer_t0_o),
      .t1_o(outer_t1_o),
      .hit_o(outer_hit_o)
  );
endmodule
