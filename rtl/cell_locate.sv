// cell_locate: for each lane hit, where the ray's segment begins and ends in the box's grid, as a key (designs with
// tables), or which cells it touches, as a mask (COMPARATORS). A lane whose object mask is full passes unasked.
//
//   in   tested   node: the lanes hit
//   out  located  node: the same, with the lanes asked; survivors are those hit, order is 0
//   latency LATENCY (C++: cell_locate.latency or comparators.latency), counted from the last cycle at the entrance, which a
//           node with a lanes asked keeps for ceil(a / UNITS) cycles, at least one. stalls: output_full
//   twin    model/pipeline/cell_locate.h
//   stated  docs/unit.md
//   arithmetic  cell_locate_lane or comparator_lane, one for each unit
//
// Lanes are located in their order, UNITS a cycle. The context's registers keep their values while its token is inside, so
// they are read in every cycle at the entrance, full_lanes in that of the pop. They hold [axis][lane], lane 0 of axis x in
// the lowest 32 bits; t0 and t1 hold [lane]; vectors of three hold axis x lowest. Each unit's result is written in the
// cycle in which its lane's latency is over, those of a node's last lanes in the cycle in which the node is pushed.
`include "tokens.svh"

module cell_locate #(
    parameter int COMPARATORS = 0,  // 0: keys; 1: masks
    parameter int R = 4,  // of masks
    parameter int R_RAY = 4,  // of keys
    parameter int UNITS = 1,
    parameter int LATENCY = 10,
    parameter int SLOT_BITS = 5,
    parameter int KEY_BITS = COMPARATORS != 0 ? R * R * R : 31  // not to be set
) (
    input  logic                                 clk_i,
    input  logic                                 rst_i,
    input  logic                                 tested_valid_i,
    input  logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] tested_data_i,
    output logic                                 tested_pop_o,
    input  logic                                 located_ready_i,
    output logic                                 located_push_o,
    output logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] located_data_o,
    // The context at the entrance.
    output logic [                SLOT_BITS-1:0] context_slot_o,
    input  logic [                        383:0] times_near_down_i,
    input  logic [                        383:0] times_near_up_i,
    input  logic [                        383:0] times_far_down_i,
    input  logic [                        383:0] times_far_up_i,
    input  logic [                        127:0] times_t0_i,
    input  logic [                        127:0] times_t1_i,
    input  logic [                        767:0] boxes_i,      // lo, above it hi
    input  logic [                          3:0] full_lanes_i,
    input  logic [                         95:0] ray_origin_i,
    input  logic [                          2:0] ray_zero_axes_i,
    input  logic [                          2:0] ray_negative_axes_i,
    // A key or mask for each unit, all of one context; unit 0 lowest.
    output logic [                    UNITS-1:0] key_write_o,
    output logic [                SLOT_BITS-1:0] key_slot_o,
    output logic [                  2*UNITS-1:0] key_lane_o,
    output logic [           KEY_BITS*UNITS-1:0] key_o,
    output logic [                          3:0] activity_o
);
  // A token at the link: what it brings, and the lanes asked.
  logic [SLOT_BITS-1:0] slot;
  logic [3:0] hits, asked;
  wire unused_fields = &{1'b0, tested_data_i[`CTU_NODE_FIELDS-5:0]};
  assign slot = tested_data_i[SLOT_BITS+`CTU_NODE_FIELDS-1:`CTU_NODE_FIELDS];
  assign hits = tested_data_i[`CTU_NODE_FIELDS-1-:4];
`ifdef CTU_MUTATE_CELL_LOCATE_FULL_LANES_ASKED
  assign asked = hits;
  wire unused_full = &{1'b0, full_lanes_i};
`else
  assign asked = hits & ~full_lanes_i;
`endif

  // Cycles at the entrance: ceil(lanes asked / UNITS), at least one.
  logic [2:0] lanes, occupies;
  always_comb begin
    lanes = {2'd0, asked[0]} + {2'd0, asked[1]} + {2'd0, asked[2]} + {2'd0, asked[3]};
    occupies = 3'd1;
    for (int cycles = 2; cycles <= 4; cycles++) begin
      if (32'(lanes) > (cycles - 1) * UNITS) occupies = 3'(cycles);
    end
`ifdef CTU_MUTATE_CELL_LOCATE_ENTRANCE_ALWAYS_FREE
    occupies = 3'd1;
`endif
  end

  logic enter, start, enable, can_enter, exit_valid, empty;
  assign enter = tested_valid_i && can_enter;
  assign tested_pop_o = enter;
  pipe_control #(
      .LATENCY(LATENCY),
      .OCCUPIES_BITS(3)
  ) control (
      .clk_i,
      .rst_i,
      .enter_i(enter),
      .occupies_i(occupies),
      .ready_i(located_ready_i),
      .can_enter_o(can_enter),
      .start_o(start),
      .enable_o(enable),
      .exit_valid_o(exit_valid),
      .exit_o(located_push_o),
      .empty_o(empty)
  );
  assign activity_o = exit_valid && !located_ready_i ? `CTU_OUTPUT_FULL : enter || !empty ? `CTU_BUSY : `CTU_IDLE;

  // The node at the entrance: in the cycle of its pop from the link, then held, with the lanes not yet located.
  logic [SLOT_BITS-1:0] held_slot_q;
  logic [3:0] held_hits_q, held_asked_q, rest_q, rest, rest_after;
  wire [SLOT_BITS-1:0] entrance_slot = can_enter ? slot : held_slot_q;
  wire [3:0] entrance_hits = can_enter ? hits : held_hits_q;
  wire [3:0] entrance_asked = can_enter ? asked : held_asked_q;
  assign rest = enter ? asked : can_enter ? 4'd0 : rest_q;
  assign context_slot_o = entrance_slot;
  always_ff @(posedge clk_i) begin
    if (enable) begin
      held_slot_q <= entrance_slot;
      held_hits_q <= entrance_hits;
      held_asked_q <= entrance_asked;
      rest_q <= rest_after;
    end
  end

  // The node's token beside the lanes. The last lanes enter with it, so nothing of it is written after it.
  logic [SLOT_BITS-1:0] located_slot;
  logic [3:0] located_hits, located_asked;
  wire unused_start = start;
  pipe_row #(
      .WIDTH(SLOT_BITS + 8),
      .DEPTH(LATENCY)
  ) row_token (
      .clk_i,
      .enable_i(enable),
      .data_i({entrance_slot, entrance_hits, entrance_asked}),
      .data_o({located_slot, located_hits, located_asked})
  );
  assign located_data_o = {located_slot, located_hits, located_hits, 8'd0, located_asked};
  assign key_slot_o = located_slot;

  // Unit u takes the lowest lane that those before it have left.
  logic [UNITS-1:0] takes;
  logic [2*UNITS-1:0] lane_of;
  always_comb begin
    rest_after = rest;
    for (int unit_index = 0; unit_index < UNITS; unit_index++) begin
      takes[unit_index] = rest_after != 4'd0;
      lane_of[2*unit_index+:2] = rest_after[0] ? 2'd0 : rest_after[1] ? 2'd1 : rest_after[2] ? 2'd2 : 2'd3;
      rest_after = rest_after & (rest_after - 4'd1);
    end
  end

  generate
    for (genvar unit_index = 0; unit_index < UNITS; unit_index++) begin : g_unit
      wire [1:0] lane = lane_of[2*unit_index+:2];
      logic [LATENCY-1:0] valid_q;
      always_ff @(posedge clk_i) begin
        if (rst_i) valid_q <= '0;
        else if (enable) valid_q <= LATENCY'({valid_q, takes[unit_index]});
      end
      assign key_write_o[unit_index] = valid_q[LATENCY-1] && enable;
      pipe_row #(
          .WIDTH(2),
          .DEPTH(LATENCY)
      ) row_lane (
          .clk_i,
          .enable_i(enable),
          .data_i(lane),
          .data_o(key_lane_o[2*unit_index+:2])
      );

      logic [95:0] lo, hi, near_down, near_up, far_down, far_up;
      for (genvar axis = 0; axis < 3; axis++) begin : g_axis
        assign lo[32*axis+:32] = boxes_i[128*axis+32*lane+:32];
        assign hi[32*axis+:32] = boxes_i[384+128*axis+32*lane+:32];
        assign near_down[32*axis+:32] = times_near_down_i[128*axis+32*lane+:32];
        assign near_up[32*axis+:32] = times_near_up_i[128*axis+32*lane+:32];
        assign far_down[32*axis+:32] = times_far_down_i[128*axis+32*lane+:32];
        assign far_up[32*axis+:32] = times_far_up_i[128*axis+32*lane+:32];
      end
      if (COMPARATORS != 0) begin : g_comparators
        comparator_lane #(
            .R(R),
            .LATENCY(LATENCY)
        ) datapath (
            .clk_i,
            .enable_i(enable),
            .lo_i(lo),
            .hi_i(hi),
            .origin_i(ray_origin_i),
            .zero_axes_i(ray_zero_axes_i),
            .negative_axes_i(ray_negative_axes_i),
            .near_down_i(near_down),
            .near_up_i(near_up),
            .far_down_i(far_down),
            .far_up_i(far_up),
            .t0_i(times_t0_i[32*lane+:32]),
            .t1_i(times_t1_i[32*lane+:32]),
            .mask_o(key_o[KEY_BITS*unit_index+:KEY_BITS])
        );
      end else begin : g_tables
        cell_locate_lane #(
            .R_RAY(R_RAY),
            .LATENCY(LATENCY)
        ) datapath (
            .clk_i,
            .enable_i(enable),
            .lo_i(lo),
            .hi_i(hi),
            .origin_i(ray_origin_i),
            .zero_axes_i(ray_zero_axes_i),
            .negative_axes_i(ray_negative_axes_i),
            .near_down_i(near_down),
            .near_up_i(near_up),
            .far_down_i(far_down),
            .far_up_i(far_up),
            .t0_i(times_t0_i[32*lane+:32]),
            .t1_i(times_t1_i[32*lane+:32]),
            .key_o(key_o[KEY_BITS*unit_index+:KEY_BITS])
        );
      end
    end
  endgenerate
endmodule
