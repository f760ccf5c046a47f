// Rays join a packet one after the other; its bounds go to a lane of packet_cull as docs/unit.md times it.
`include "packet_bounds.svh"

module packet_lane_bench (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic        join_i,
    input  logic        first_i,
    input  logic [95:0] origin_i,
    input  logic [95:0] rcp_down_i,
    input  logic [95:0] rcp_up_i,
    input  logic [ 2:0] zero_axes_i,
    input  logic [ 2:0] negative_axes_i,
    input  logic [31:0] tmin_i,
    input  logic [31:0] tmax_i,
    input  logic [95:0] lo_i,
    input  logic [95:0] hi_i,
    output logic        hit_o,
    output logic        sure_o,
    output logic [31:0] t0_o
);
  logic [`CTU_PACKET_BITS-1:0] joined, bounds_q;
  packet_join join_bounds (
      .first_i,
      .before_i(bounds_q),
      .origin_i,
      .rcp_down_i,
      .rcp_up_i,
      .zero_axes_i,
      .negative_axes_i,
      .tmin_i,
      .tmax_i,
      .after_o(joined)
  );
  always_ff @(posedge clk_i) if (join_i) bounds_q <= joined;
  packet_test_lane lane (
      .clk_i,
      .enable_i,
      .lo_i,
      .hi_i,
      .bounds_i(bounds_q),
      .hit_o,
      .sure_o,
      .t0_o
  );
endmodule
