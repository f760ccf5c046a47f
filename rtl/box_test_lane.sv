// box_test_lane: the ray against one box, with outward rounding; the datapath of one of box_test's lanes.
//
//   latency SUBTRACT_LATENCY + MULTIPLY_LATENCY + COMPARE_LATENCY (docs/unit.md: 4 + 4 + 3), initiation interval 1;
//           enable_i stops all registers
//   twin    one lane of ctu::intersect::slab_test, without INNER of slab_test_outer (model/intersect/slab_test.h)
//
// Arithmetic: slab_axis on each axis, then slab_overlap of near_down and far_up with tmin and tmax. No NaN occurs for a
// valid ray. Vectors of three hold axis x in the lowest 32 bits.
module box_test_lane #(
    parameter int SUBTRACT_LATENCY = 4,
    parameter int MULTIPLY_LATENCY = 4,
    parameter int COMPARE_LATENCY = 3,
    parameter bit INNER = 1'b1  // 0: the bounds by axis are zero
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [95:0] lo_i,
    input  logic [95:0] hi_i,
    input  logic [95:0] origin_i,
    input  logic [95:0] rcp_down_i,
    input  logic [95:0] rcp_up_i,
    input  logic [ 2:0] zero_axes_i,
    input  logic [ 2:0] negative_axes_i,
    input  logic [31:0] tmin_i,
    input  logic [31:0] tmax_i,           // the best hit so far
    output logic [95:0] near_down_o,
    output logic [95:0] near_up_o,
    output logic [95:0] far_down_o,
    output logic [95:0] far_up_o,
    output logic [31:0] t0_o,
    output logic [31:0] t1_o,
    output logic        hit_o
);
  logic [95:0] near_down, near_up, far_down, far_up;
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_axis
      slab_axis #(
          .SUBTRACT_LATENCY(SUBTRACT_LATENCY),
          .MULTIPLY_LATENCY(MULTIPLY_LATENCY),
          .INNER(INNER)
      ) slab (
          .clk_i,
          .enable_i,
          .lo_i(lo_i[32*axis+:32]),
          .hi_i(hi_i[32*axis+:32]),
          .origin_i(origin_i[32*axis+:32]),
          .rcp_down_i(rcp_down_i[32*axis+:32]),
          .rcp_up_i(rcp_up_i[32*axis+:32]),
          .zero_i(zero_axes_i[axis]),
          .negative_i(negative_axes_i[axis]),
          .near_down_o(near_down[32*axis+:32]),
          .near_up_o(near_up[32*axis+:32]),
          .far_down_o(far_down[32*axis+:32]),
          .far_up_o(far_up[32*axis+:32])
      );
    end
  endgenerate
  generate
    if (INNER) begin : g_times
      pipe_row #(
          .WIDTH(384),
          .DEPTH(COMPARE_LATENCY)
      ) row_times (
          .clk_i,
          .enable_i,
          .data_i({near_down, near_up, far_down, far_up}),
          .data_o({near_down_o, near_up_o, far_down_o, far_up_o})
      );
    end else begin : g_no_times
      wire unused_inner = &{1'b0, near_up, far_down};
      assign {near_down_o, near_up_o, far_down_o, far_up_o} = '0;
    end
  endgenerate

  logic [31:0] tmin_q, tmax_q;
  pipe_row #(
      .WIDTH(64),
      .DEPTH(SUBTRACT_LATENCY + MULTIPLY_LATENCY)
  ) row_interval (
      .clk_i,
      .enable_i,
      .data_i({tmin_i, tmax_i}),
      .data_o({tmin_q, tmax_q})
  );

  slab_overlap #(
      .LATENCY(COMPARE_LATENCY)
  ) overlap (
      .clk_i,
      .enable_i,
      .begin_i(tmin_q),
      .slab_begins_i(near_down),
      .end_i(tmax_q),
      .slab_ends_i(far_up),
      .t0_o,
      .t1_o,
      .hit_o
  );
endmodule
