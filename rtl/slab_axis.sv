// slab_axis: where a ray meets the two face planes of one box on one axis, enclosed by bounds rounded outwards.
//
//   latency SUBTRACT_LATENCY + MULTIPLY_LATENCY, initiation interval 1; enable_i stops all registers
//   twin    one axis of ctu::intersect::slab_test (model/intersect/slab_test.h)
//
// Arithmetic: an axis along which the ray moves down is mirrored (signs flipped, exact), so that the lower face is the
// near one; slab_bound gives the bounds. Along an axis on which the ray does not move they are infinite: open where the
// origin lies in the closed slab, crossed where not.
// Without INNER only near_down_o and far_up_o are built; the others are zero.
`include "float_format.svh"

module slab_axis #(
    parameter int SUBTRACT_LATENCY = 4,
    parameter int MULTIPLY_LATENCY = 4,
    parameter bit INNER = 1'b1
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] lo_i,
    input  logic [31:0] hi_i,
    input  logic [31:0] origin_i,
    input  logic [31:0] rcp_down_i,   // rcp_down <= 1/direction <= rcp_up
    input  logic [31:0] rcp_up_i,
    input  logic        zero_i,       // the direction is zero here
    input  logic        negative_i,   // the direction is negative here
    output logic [31:0] near_down_o,  // of the plane that the ray meets first
    output logic [31:0] near_up_o,
    output logic [31:0] far_down_o,
    output logic [31:0] far_up_o
);
  logic [31:0] near_plane, far_plane, origin, rcp_smaller, rcp_larger;
  always_comb begin
    near_plane = negative_i ? {~hi_i[31], hi_i[30:0]} : lo_i;
    far_plane = negative_i ? {~lo_i[31], lo_i[30:0]} : hi_i;
`ifdef CTU_MUTATE_UNMIRRORED_PLANES
    near_plane = {lo_i[31] ^ negative_i, lo_i[30:0]};
    far_plane = {hi_i[31] ^ negative_i, hi_i[30:0]};
`endif
    origin = {origin_i[31] ^ negative_i, origin_i[30:0]};
    rcp_smaller = negative_i ? {~rcp_up_i[31], rcp_up_i[30:0]} : rcp_down_i;
    rcp_larger = negative_i ? {~rcp_down_i[31], rcp_down_i[30:0]} : rcp_up_i;
  end

  logic [31:0] rcp_smaller_q, rcp_larger_q;
  pipe_row #(
      .WIDTH(64),
      .DEPTH(SUBTRACT_LATENCY)
  ) row_reciprocals (
      .clk_i,
      .enable_i,
      .data_i({rcp_smaller, rcp_larger}),
      .data_o({rcp_smaller_q, rcp_larger_q})
  );

  // The ray that stands still on this axis: in the closed slab or not.
  logic lo_above, hi_below, on_lo, on_hi, outside, standing_q, outside_q, unused_nan_lo, unused_nan_hi;
  float_compare compare_lo (
      .a_i(origin_i),
      .b_i(lo_i),
      .less_o(lo_above),
      .equal_o(on_lo),
      .unordered_o(unused_nan_lo)
  );
  float_compare compare_hi (
      .a_i(hi_i),
      .b_i(origin_i),
      .less_o(hi_below),
      .equal_o(on_hi),
      .unordered_o(unused_nan_hi)
  );
`ifdef CTU_MUTATE_OPEN_SLAB
  assign outside = lo_above || hi_below || on_lo || on_hi;
`else
  assign outside = lo_above || hi_below;
  wire unused_faces = &{1'b0, on_lo, on_hi};  // the slab is closed
`endif
  pipe_row #(
      .WIDTH(2),
      .DEPTH(SUBTRACT_LATENCY + MULTIPLY_LATENCY)
  ) row_standing (
      .clk_i,
      .enable_i,
      .data_i({zero_i, outside}),
      .data_o({standing_q, outside_q})
  );

  // The bounds: near down, far up, and the two inner ones near up, far down.
  localparam int BOUNDS = INNER ? 4 : 2;
  logic [127:0] times;
  generate
    for (genvar bound = 0; bound < 4; bound++) begin : g_bound
      if (bound < BOUNDS) begin : g_built
        localparam bit IS_FAR = bound[0];
        localparam bit ROUNDS_UP = bound[0] != bound[1];

        logic [31:0] moving;
        slab_bound #(
            .SUBTRACT_LATENCY(SUBTRACT_LATENCY),
            .MULTIPLY_LATENCY(MULTIPLY_LATENCY),
            .ROUNDS_UP(ROUNDS_UP)
        ) moving_bound (
            .clk_i,
            .enable_i,
            .plane_i(IS_FAR ? far_plane : near_plane),
            .origin_i(origin),
            .rcp_smaller_i(rcp_smaller_q),
            .rcp_larger_i(rcp_larger_q),
            .time_o(moving)
        );
        assign times[32*bound+:32] =
            !standing_q ? moving : (IS_FAR == outside_q) ? `FLOAT_MINUS_INFINITY : `FLOAT_PLUS_INFINITY;
      end else begin : g_left_out
        assign times[32*bound+:32] = 32'd0;
      end
    end
  endgenerate
  assign near_down_o = times[31:0];
  assign far_up_o = times[63:32];
  assign near_up_o = times[95:64];
  assign far_down_o = times[127:96];
endmodule
