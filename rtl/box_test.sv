// box_test: the ray against the boxes of a node's four lanes, with outward rounding.
//
//   latency LATENCY (docs/unit.md: 4 subtract, 4 multiply, 3 compare: 11), initiation interval 1; where BOX_BITS is
//           below 32, DECODE_LATENCY (docs/unit.md: 5) in front of it, in the same rigid pipeline
//   twin    model/pipeline/box_test.h; intersect::slab_test, without INNER slab_test_outer (model/intersect)
//
// Arithmetic: box_test_lane, four times. Any LATENCY from 1 is shared out in the proportion of those three. What the
// ray is and what its best hit is do not change while the node is tested, so they are read once: with the token, or when
// its boxes are decoded (box_decode). Decoded boxes are handed on for cell_locate.
//
// Vectors by axis and lane hold lane l of axis a at [32 * (4 * a + l) +: 32], as the bytes of a node lie in memory
// (model/accel/image.h); vectors of three hold axis x in the lowest 32 bits. Without INNER only t0, t1 and hits are
// built, and the times by axis and lane are zero.
`include "tokens.svh"

module box_test #(
    parameter int SLOT_BITS = 5,
    parameter int LATENCY = 11,
    parameter bit INNER = 1'b1,  // 0: design none, no stage asks for the times by axis
    parameter int BOX_BITS = 32,  // of a coordinate of boxes_i: 32, or 16, 12, 8
    parameter int DECODE_LATENCY = 5,
    localparam int BOXES_BITS = BOX_BITS == 32 ? 768 : 128 + 24 * BOX_BITS
) (
    input  logic                                  clk_i,
    input  logic                                  rst_i,
    input  logic                                  node_valid_i,
    input  logic [                SLOT_BITS+31:0] node_data_i,          // a ref
    output logic                                  node_pop_o,
    input  logic                                  tested_ready_i,
    output logic                                  tested_push_o,
    output logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] tested_data_o,        // a node; survivors as hits, order and asked 0
    // The context of the node popped: the boxes that node_fetch holds for it. Full precision: lo, above it hi, bytes 0 ..
    // 95; reduced: frame, above it planes, and the lanes without a child.
    output logic [                 SLOT_BITS-1:0] boxes_slot_o,
    input  logic [                BOXES_BITS-1:0] boxes_i,
    input  logic [                           3:0] empty_i,
    // The context of the node whose boxes are there: its ray and best hit.
    output logic [                 SLOT_BITS-1:0] ray_slot_o,
    input  logic [                          95:0] ray_origin_i,
    input  logic [                          95:0] ray_rcp_down_i,
    input  logic [                          95:0] ray_rcp_up_i,
    input  logic [                           2:0] ray_zero_axes_i,
    input  logic [                           2:0] ray_negative_axes_i,
    input  logic [                          31:0] ray_tmin_i,
    input  logic [                          31:0] best_t_i,
    // The same context: its boxes decoded, in the one cycle in which they are; never at full precision.
    output logic                                  decoded_write_o,
    output logic [                         767:0] decoded_boxes_o,
    // The context of the token pushed: where its ray meets the boxes.
    output logic                                  times_write_o,
    output logic [                 SLOT_BITS-1:0] times_slot_o,
    output logic [                         383:0] times_near_down_o,
    output logic [                         383:0] times_near_up_o,
    output logic [                         383:0] times_far_down_o,
    output logic [                         383:0] times_far_up_o,
    output logic [                         127:0] times_t0_o,
    output logic [                         127:0] times_t1_o,
    output logic [                           3:0] activity_o
);
  localparam int COMPARE_LATENCY = 3 * LATENCY / 11;
  localparam int SUBTRACT_LATENCY = (LATENCY - COMPARE_LATENCY) / 2;
  localparam int MULTIPLY_LATENCY = LATENCY - COMPARE_LATENCY - SUBTRACT_LATENCY;

  wire unused_reference = &{1'b0, node_data_i[31:0]};  // node_fetch knows by the context which bytes they are
  assign boxes_slot_o = node_data_i[32+:SLOT_BITS];
  localparam int IN_FRONT = BOX_BITS == 32 ? 0 : DECODE_LATENCY;  // cycles before the lanes

  logic can_enter, enable, empty, unused_start, unused_exit_valid;  // a token starts while it is popped
  assign node_pop_o = node_valid_i && can_enter;
  pipe_control #(
      .LATENCY(IN_FRONT + LATENCY)
  ) control (
      .clk_i,
      .rst_i,
      .enter_i(node_pop_o),
      .occupies_i(1'b1),
      .ready_i(tested_ready_i),
      .can_enter_o(can_enter),
      .start_o(unused_start),
      .enable_o(enable),
      .exit_valid_o(unused_exit_valid),
      .exit_o(tested_push_o),
      .empty_o(empty)
  );

  // Boxes, and the slot that comes with them.
  logic [767:0] boxes;
  generate
    if (BOX_BITS == 32) begin : g_full_boxes
      wire unused_empty = &{1'b0, empty_i};  // empty boxes say so themselves
      assign ray_slot_o = boxes_slot_o;
      assign boxes = boxes_i;
      assign decoded_write_o = 1'b0;
    end else begin : g_compact_boxes
      pipe_row #(
          .WIDTH(SLOT_BITS),
          .DEPTH(DECODE_LATENCY)
      ) row_decoded_slot (
          .clk_i,
          .enable_i(enable),
          .data_i(boxes_slot_o),
          .data_o(ray_slot_o)
      );
      box_decode #(
          .BITS(BOX_BITS),
          .LATENCY(DECODE_LATENCY)
      ) decode (
          .clk_i,
          .enable_i(enable),
          .origin_i(boxes_i[95:0]),
          .exponents_i(boxes_i[127:96]),
          .planes_i(boxes_i[BOXES_BITS-1:128]),
          .empty_i,
          .boxes_o(boxes)
      );
      logic [DECODE_LATENCY-1:0] decodes_q;  // where there is a node in the decoder
      always_ff @(posedge clk_i) begin
        if (rst_i) decodes_q <= '0;
        else if (enable) decodes_q <= DECODE_LATENCY'({decodes_q, node_pop_o});
      end
      assign decoded_write_o = decodes_q[DECODE_LATENCY-1] && enable;
    end
  endgenerate
  assign decoded_boxes_o = boxes;

  pipe_row #(
      .WIDTH(SLOT_BITS),
`ifdef CTU_MUTATE_BOX_SLOT_EARLY
      .DEPTH(LATENCY - 1)
`else
      .DEPTH(LATENCY)
`endif
  ) row_slot (
      .clk_i,
      .enable_i(enable),
      .data_i(ray_slot_o),
      .data_o(times_slot_o)
  );

  logic [3:0] hits;
  generate
    for (genvar lane = 0; lane < 4; lane++) begin : g_lane
      logic [95:0] lo, hi, near_down, near_up, far_down, far_up;
      box_test_lane #(
          .SUBTRACT_LATENCY(SUBTRACT_LATENCY),
          .MULTIPLY_LATENCY(MULTIPLY_LATENCY),
          .COMPARE_LATENCY(COMPARE_LATENCY),
          .INNER(INNER)
      ) test (
          .clk_i,
          .enable_i(enable),
          .lo_i(lo),
          .hi_i(hi),
          .origin_i(ray_origin_i),
          .rcp_down_i(ray_rcp_down_i),
          .rcp_up_i(ray_rcp_up_i),
          .zero_axes_i(ray_zero_axes_i),
          .negative_axes_i(ray_negative_axes_i),
          .tmin_i(ray_tmin_i),
          .tmax_i(best_t_i),
          .near_down_o(near_down),
          .near_up_o(near_up),
          .far_down_o(far_down),
          .far_up_o(far_up),
          .t0_o(times_t0_o[32*lane+:32]),
          .t1_o(times_t1_o[32*lane+:32]),
          .hit_o(hits[lane])
      );
      for (genvar axis = 0; axis < 3; axis++) begin : g_axis
`ifdef CTU_MUTATE_BOX_AXES_SWAPPED
        localparam int FROM = 2 - axis;
`else
        localparam int FROM = axis;
`endif
        assign lo[32*axis+:32] = boxes[32*(4*FROM+lane)+:32];
        assign hi[32*axis+:32] = boxes[32*(12+4*FROM+lane)+:32];
        assign times_near_down_o[32*(4*axis+lane)+:32] = near_down[32*axis+:32];
        assign times_near_up_o[32*(4*axis+lane)+:32] = near_up[32*axis+:32];
        assign times_far_down_o[32*(4*axis+lane)+:32] = far_down[32*axis+:32];
        assign times_far_up_o[32*(4*axis+lane)+:32] = far_up[32*axis+:32];
      end
    end
  endgenerate
  assign tested_data_o = {times_slot_o, hits, hits, 12'd0};
  assign times_write_o = tested_push_o;

  assign activity_o = !enable ? `CTU_OUTPUT_FULL : node_pop_o || !empty ? `CTU_BUSY : `CTU_IDLE;
endmodule
