// packet_cull: the rays of a packet look for the places where they must go on alone, once for all of them; the rays then
// begin there and not at the root.
//
//   in   rays          contexts whose registers are set up, in the order of the feed
//   in   nodes         nodes of packets whose bytes have come
//   in   released      packets whose rays have all begun
//   out  to_scheduler  the node that a packet is asked about next, under the number of its first ray's context
//   out  starts        rays that go on alone, with their packet; one a cycle, packet after packet
//   latency a ray joins in the cycle in which it is taken; a node keeps the entrance for interval_i cycles and has its
//           answer LATENCY cycles later, from 1; where BOX_BITS is below 32, DECODE_LATENCY more
//   twin    model/pipeline/packet_cull.h; arithmetic: ctu::cull::packet::PacketSlabs (packet_join, packet_test_lane)
//   stated  docs/unit.md
//
// Children are tested in as many lanes as MIN_INTERVAL needs, in the last cycles in which the node keeps the entrance.
// The pipeline never stands: what it brings goes into registers. LATENCY is spread over the steps in proportion to where
// they end at LATENCY 12: distances 4, products 8, comparisons 11, the search (entry_search) 12.
//
// The rays of a packet are a list through the contexts: each knows the next one, and the packet its first and its last.
`include "packet_bounds.svh"
`include "tokens.svh"

module packet_cull #(
    parameter int SLOT_BITS = 5,
    parameter int PACKETS = 8,         // under way at once, at most
    parameter int ENTRIES = 8,         // of a packet at most, 1 .. 16
    parameter int LATENCY = 12,
    parameter int MIN_INTERVAL = 4,
    parameter int BOX_BITS = 32,       // of a coordinate of boxes_i: 32, or 16, 12, 8
    parameter int DECODE_LATENCY = 5,
    parameter int TREES = 1,           // of the image; all rays of a packet walk one
    localparam int PACKET_BITS = PACKETS <= 2 ? 1 : $clog2(PACKETS),
    localparam int BOXES_BITS = BOX_BITS == 32 ? 768 : 128 + 24 * BOX_BITS
) (
    input logic clk_i,
    input logic rst_i,

    // Straps.
    input logic [PACKET_BITS:0] packets_i,       // in use, 1 .. PACKETS
    input logic [          4:0] most_entries_i,  // 1 .. ENTRIES
    input logic [          6:0] interval_i,      // at least MIN_INTERVAL

    input  logic                             rays_valid_i,
    input  logic [            SLOT_BITS+1:0] rays_data_i,           // {slot, joins, closes}
    output logic                             rays_pop_o,
    input  logic                             nodes_valid_i,
    input  logic [           SLOT_BITS+31:0] nodes_data_i,          // a ref
    output logic                             nodes_pop_o,
    input  logic                             released_valid_i,
    input  logic [          PACKET_BITS-1:0] released_data_i,
    output logic                             released_pop_o,
    input  logic                             to_scheduler_ready_i,
    output logic                             to_scheduler_push_o,
    output logic [           SLOT_BITS+31:0] to_scheduler_data_o,   // a ref
    input  logic                             starts_ready_i,
    output logic                             starts_push_o,
    output logic [  SLOT_BITS+PACKET_BITS:0] starts_data_o,         // {slot, packet, last}

    // The ray that joins.
    output logic [SLOT_BITS-1:0] ray_slot_o,
    input  logic [         95:0] ray_origin_i,         // x in the lowest bits
    input  logic [         95:0] ray_rcp_down_i,
    input  logic [         95:0] ray_rcp_up_i,
    input  logic [          2:0] ray_zero_axes_i,
    input  logic [          2:0] ray_negative_axes_i,
    input  logic [         31:0] ray_tmin_i,
    input  logic [         31:0] ray_tmax_i,
    input  logic [         31:0] ray_root_i,           // of its tree

    // The node at the entrance: its boxes as node_fetch holds them, and which lanes have no child.
    output logic [ SLOT_BITS-1:0] boxes_slot_o,
    input  logic [BOXES_BITS-1:0] boxes_i,
    input  logic [           3:0] empty_i,
    // The node that has been tested.
    output logic [ SLOT_BITS-1:0] children_slot_o,
    input  logic [         127:0] children_i,

    // What a packet has found: entries {t0, reference}, the nearest lowest, and their number.
    input  logic [PACKET_BITS-1:0] entries_packet_i,
    output logic [ 64*ENTRIES-1:0] entries_o,
    input  logic [PACKET_BITS-1:0] count_packet_i,
    output logic [            4:0] count_o,

    output logic [3:0] activity_o
);
  localparam int SLOTS = 1 << SLOT_BITS;
  localparam int PLACES = 1 << PACKET_BITS;
  localparam int IN_FRONT = BOX_BITS == 32 ? 0 : DECODE_LATENCY;  // cycles before the lanes

  // Steps of the pipeline, and how the lanes share the children.
  localparam int DISTANCES = 4 * LATENCY / 12;
  localparam int PRODUCTS = 8 * LATENCY / 12;
  localparam int COMPARISONS = 11 * LATENCY / 12;
  localparam int TURNS_AT_MOST = MIN_INTERVAL < 4 ? MIN_INTERVAL : 4;
  localparam int LANES = (4 + TURNS_AT_MOST - 1) / TURNS_AT_MOST;
  localparam int TURNS = (4 + LANES - 1) / LANES;

  // Free packets: those never used yet, then those given back, in their order.
  logic [PACKET_BITS:0] unused_from_q;
  logic given_back, takes_given;
  logic [PACKET_BITS-1:0] given_packet;
  wire fresh = unused_from_q != packets_i;
  arrival_queue #(
      .SLOT_BITS(PACKET_BITS)
  ) free (
      .clk_i,
      .rst_i,
      .first_push_i(released_valid_i),
      .first_slot_i(released_data_i),
      .second_push_i(1'b0),
      .second_slot_i({PACKET_BITS{1'b0}}),
      .pop_i(takes_given),
      .valid_o(given_back),
      .slot_o(given_packet)
  );
  assign released_pop_o = released_valid_i;

  // Rays join the one packet that is filling.
  logic filling_q;
  logic [PACKET_BITS-1:0] filling_packet_q;
  logic [SLOT_BITS-1:0] last_slot_q;
  wire joins = rays_data_i[1];
  wire closes = rays_data_i[0];
  assign ray_slot_o = rays_data_i[2+:SLOT_BITS];
  wire waits = rays_valid_i && !filling_q && joins && !fresh && !given_back;
  assign rays_pop_o = rays_valid_i && !waits;
  wire ray_joins = rays_pop_o && joins;
  wire opens = ray_joins && !filling_q;
  wire closed = rays_pop_o && closes && (filling_q || joins);
  wire [PACKET_BITS-1:0] packet =
      filling_q ? filling_packet_q : fresh ? unused_from_q[PACKET_BITS-1:0] : given_packet;
  assign takes_given = opens && !fresh;
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      unused_from_q <= '0;
      filling_q <= 1'b0;
    end else begin
      unused_from_q <= unused_from_q + (PACKET_BITS + 1)'(opens && fresh);
      if (rays_pop_o) filling_q <= !closes && (filling_q || joins);
    end
    if (opens) filling_packet_q <= packet;
    if (ray_joins) last_slot_q <= ray_slot_o;
  end

  // A packet walks the tree of its first ray.
  logic [31:0] root;
  generate
    if (TREES > 1) begin : g_roots
      logic [31:0] root_q;
      assign root = opens ? ray_root_i : root_q;
      always_ff @(posedge clk_i) root_q <= root;
    end else begin : g_root
      assign root = 32'd0;
      wire unused_root = &{1'b0, ray_root_i};
    end
  endgenerate

  logic [`CTU_PACKET_BITS-1:0] joined_q, joined, bounds;
  packet_join join_bounds (
      .first_i(!filling_q),
      .before_i(joined_q),
      .origin_i(ray_origin_i),
      .rcp_down_i(ray_rcp_down_i),
      .rcp_up_i(ray_rcp_up_i),
      .zero_axes_i(ray_zero_axes_i),
      .negative_axes_i(ray_negative_axes_i),
      .tmin_i(ray_tmin_i),
      .tmax_i(ray_tmax_i),
      .after_o(joined)
  );
  always_ff @(posedge clk_i) if (ray_joins) joined_q <= joined;
  wire [`CTU_PACKET_BITS-1:0] whole = joins ? joined : joined_q;

  // The list of a packet's rays.
  logic [SLOT_BITS-1:0] first_ray_q[PLACES], last_ray_q[PLACES], next_ray_q[SLOTS];
  logic [PACKET_BITS-1:0] packet_of_q[SLOTS];  // by the first ray's context
  always_ff @(posedge clk_i) begin
    if (opens) begin
      first_ray_q[packet] <= ray_slot_o;
      packet_of_q[ray_slot_o] <= packet;
    end
    if (ray_joins) begin
      last_ray_q[packet] <= ray_slot_o;
      if (filling_q) next_ray_q[last_slot_q] <= ray_slot_o;
    end
  end

  // Packets that wait for a node, and those whose rays begin.
  logic answers, done, asks, starts, starts_last;
  logic [PACKET_BITS-1:0] answered_packet, asking_packet, starting_packet;
  arrival_queue #(
      .SLOT_BITS(PACKET_BITS)
  ) asking (
      .clk_i,
      .rst_i,
      .first_push_i(answers && !done),
      .first_slot_i(answered_packet),
      .second_push_i(closed),
      .second_slot_i(packet),
      .pop_i(to_scheduler_push_o),
      .valid_o(asks),
      .slot_o(asking_packet)
  );
  arrival_queue #(
      .SLOT_BITS(PACKET_BITS)
  ) starting (
      .clk_i,
      .rst_i,
      .first_push_i(answers && done),
      .first_slot_i(answered_packet),
      .second_push_i(1'b0),
      .second_slot_i({PACKET_BITS{1'b0}}),
      .pop_i(starts_push_o && starts_last),
      .valid_o(starts),
      .slot_o(starting_packet)
  );
  logic [31:0] asked_node;
  assign to_scheduler_push_o = asks && to_scheduler_ready_i;
  assign to_scheduler_data_o = {first_ray_q[asking_packet], asked_node};

  logic started_q;  // some rays of the packet in front have begun
  logic [SLOT_BITS-1:0] next_slot_q;
  wire [SLOT_BITS-1:0] starting_slot = started_q ? next_slot_q : first_ray_q[starting_packet];
  assign starts_last = starting_slot == last_ray_q[starting_packet];
  assign starts_push_o = starts && starts_ready_i;
  assign starts_data_o = {starting_slot, starting_packet, starts_last};
  always_ff @(posedge clk_i) begin
    if (rst_i) started_q <= 1'b0;
    else if (starts_push_o) started_q <= !starts_last;
    if (starts_push_o) next_slot_q <= next_ray_q[starting_slot];
  end

  // The node at the entrance: the one that takes it in this cycle, or has taken it before.
  logic can_enter, start, unused_enable, unused_exit_valid, exit, empty;
  logic [SLOT_BITS-1:0] slot_q;
  logic [6:0] rest, rest_q;  // cycles that it still keeps the entrance, this one included
  pipe_control #(
      .LATENCY(IN_FRONT + LATENCY),
      .OCCUPIES_BITS(7)
  ) control (
      .clk_i,
      .rst_i,
      .enter_i(nodes_pop_o),
      .occupies_i(interval_i),
      .ready_i(1'b1),
      .can_enter_o(can_enter),
      .start_o(start),
      .enable_o(unused_enable),
      .exit_valid_o(unused_exit_valid),
      .exit_o(exit),
      .empty_o(empty)
  );
  assign nodes_pop_o = nodes_valid_i && can_enter;
  assign boxes_slot_o = nodes_pop_o ? nodes_data_i[32+:SLOT_BITS] : slot_q;
  assign rest = nodes_pop_o ? interval_i : rest_q;
  wire unused_reference = &{1'b0, nodes_data_i[31:0]};  // node_fetch knows by the context which bytes they are
  always_ff @(posedge clk_i) begin
    slot_q <= boxes_slot_o;
    rest_q <= rest == 7'd0 ? 7'd0 : rest - 7'd1;
  end

  // Boxes of this cycle's lanes; then the bounds of their packet.
  localparam int BITS = BOX_BITS == 32 ? 32 : BOX_BITS;
  localparam int PLANES = BOX_BITS == 32 ? 0 : 128;
  wire [1:0] turn = rest == 7'd0 || rest >= 7'(TURNS) ? 2'd0 : 2'(TURNS) - rest[1:0];
  logic [6*LANES*BITS-1:0] planes;
  logic [LANES-1:0] lane_empty;
  logic [192*LANES-1:0] boxes;
  generate
    for (genvar u = 0; u < LANES; u++) begin : g_planes
      wire [1:0] lane = 2'(32'(turn) * LANES + u);
      assign lane_empty[u] = empty_i[lane];
      for (genvar plane = 0; plane < 6; plane++) begin : g_plane
        assign planes[BITS*(LANES*plane+u)+:BITS] = boxes_i[PLANES+BITS*(4*plane+32'(lane))+:BITS];
      end
    end
    if (BOX_BITS == 32) begin : g_full_boxes
      wire unused_empty = &{1'b0, lane_empty};  // empty boxes say so themselves
      assign boxes = planes;
    end else begin : g_compact_boxes
      box_decode #(
          .BITS(BOX_BITS),
          .LATENCY(DECODE_LATENCY),
          .LANES(LANES)
      ) decode (
          .clk_i,
          .enable_i(1'b1),
          .origin_i(boxes_i[95:0]),
          .exponents_i(boxes_i[127:96]),
          .planes_i(planes),
          .empty_i(lane_empty),
          .boxes_o(boxes)
      );
    end
  endgenerate
  logic [SLOT_BITS-1:0] tested_slot;
  logic [PACKET_BITS-1:0] tested_packet, compared_packet;
  pipe_row #(
      .WIDTH(SLOT_BITS + PACKET_BITS),
      .DEPTH(IN_FRONT)
  ) row_decoded (
      .clk_i,
      .enable_i(1'b1),
      .data_i({boxes_slot_o, packet_of_q[boxes_slot_o]}),
      .data_o({tested_slot, tested_packet})
  );
  context_file #(
      .WIDTH(`CTU_PACKET_BITS),
      .SLOT_BITS(PACKET_BITS)
  ) bounds_of_packets (
      .clk_i,
      .write_i(closed),
      .write_slot_i(packet),
      .write_data_i(whole),
      .read_slot_i(tested_packet),
      .read_data_o(bounds)
  );

  // Of each lane in each turn: t0, some ray may meet the child, every ray does; all there after the last turn.
  logic [34*LANES*TURNS-1:0] answers_of_lanes;
  generate
    for (genvar u = 0; u < LANES; u++) begin : g_lane
      logic [95:0] lo, hi;
      for (genvar axis = 0; axis < 3; axis++) begin : g_axis
        assign lo[32*axis+:32] = boxes[32*(LANES*axis+u)+:32];
        assign hi[32*axis+:32] = boxes[32*(LANES*(3+axis)+u)+:32];
      end
      logic hit, sure;
      logic [31:0] t0;
      packet_test_lane #(
          .SUBTRACT_LATENCY(DISTANCES),
          .MULTIPLY_LATENCY(PRODUCTS - DISTANCES),
          .COMPARE_LATENCY(COMPARISONS - PRODUCTS)
      ) test (
          .clk_i,
          .enable_i(1'b1),
          .lo_i(lo),
          .hi_i(hi),
          .bounds_i(bounds),
          .hit_o(hit),
          .sure_o(sure),
          .t0_o(t0)
      );
      for (genvar earlier = 0; earlier < TURNS; earlier++) begin : g_turn
        pipe_row #(
            .WIDTH(34),
            .DEPTH(TURNS - 1 - earlier)
        ) row_answer (
            .clk_i,
            .enable_i(1'b1),
            .data_i({t0, sure, hit}),
            .data_o(answers_of_lanes[34*(earlier*LANES+u)+:34])
        );
      end
    end
  endgenerate
  logic [3:0] hits, sures;
  logic [127:0] t0s;
  generate
    for (genvar lane = 0; lane < 4; lane++) begin : g_answer
      assign {t0s[32*lane+:32], sures[lane], hits[lane]} = answers_of_lanes[34*lane+:34];
    end
  endgenerate

  // The search, COMPARISONS cycles behind the last lanes.
  localparam int FOUND = IN_FRONT + COMPARISONS;  // from the entrance
  logic tested;
  pipe_row #(
      .WIDTH(SLOT_BITS + PACKET_BITS),
      .DEPTH(COMPARISONS)
  ) row_tested (
      .clk_i,
      .enable_i(1'b1),
      .data_i({tested_slot, tested_packet}),
      .data_o({children_slot_o, compared_packet})
  );
  generate
    if (FOUND == 0) begin : g_tested_at_once
      assign tested = start;
    end else begin : g_tested
      logic [FOUND-1:0] starts_q;
      assign tested = starts_q[FOUND-1];
      always_ff @(posedge clk_i) begin
        if (rst_i) starts_q <= '0;
        else starts_q <= FOUND'({starts_q, start});
      end
    end
  endgenerate
  entry_search #(
      .PACKET_BITS(PACKET_BITS),
      .ENTRIES(ENTRIES),
      .LATENCY(LATENCY - COMPARISONS),
      .TREES(TREES)
  ) search (
      .clk_i,
      .rst_i,
      .most_entries_i,
      .begin_i(closed),
      .begin_packet_i(packet),
      .begin_t_i(whole[`CTU_PACKET_BEGINS+:32]),
      .begin_root_i(root),
      .ask_packet_i(asking_packet),
      .ask_node_o(asked_node),
      .tested_i(tested),
      .tested_packet_i(compared_packet),
      .children_i,
      .hit_i(hits),
      .sure_i(sures),
      .t0_i(t0s),
      .answer_o(answers),
      .answer_packet_o(answered_packet),
      .done_o(done),
      .entries_packet_i,
      .entries_o,
      .count_packet_i,
      .count_o
  );
  wire unused_exit = exit;  // in the cycle of answers

  wire blocked = (asks && !to_scheduler_ready_i) || (starts && !starts_ready_i);
  wire moved =
      to_scheduler_push_o || starts_push_o || answers || nodes_pop_o || rays_pop_o || released_pop_o;
  assign activity_o = moved || !empty ? `CTU_BUSY : blocked ? `CTU_OUTPUT_FULL : waits ? `CTU_NO_PACKET : `CTU_IDLE;
endmodule
