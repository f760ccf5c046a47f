// ctu_unit: the culling traversal unit. Rays go in at the feed, hits come out at the return, lines come from memory.
//
//   twin    model/pipeline/pipeline.h and connections.h: the same stages, joined by the same links
//
// Parameters fix its structure, straps (inputs that keep their value while it runs) the rest. What a design or a scene
// does not need is not there: DESIGN none has neither cell_locate nor mask_test, HAS_SPILLS 0 no way from the stack to
// memory, TABLE_CACHE 0 no table_fetch; with TABLE_CACHE 1 all tables lie in memory and none is on chip. PRIMITIVE_BOXES 0
// has no primitive_cull, SPHERES 0 no sphere_test and PACKETS 0 no packet_cull, nor what only these read; TREES 1 no table of
// roots.
//
// The register files of the contexts lie between the stages: rays, best hits, times of the slab test, and keys or touched
// cells. Nodes, leaves and stacks by context are in node_fetch, leaf_fetch and traversal_stack.
`include "mask_designs.svh"
`include "links.svh"
`include "tokens.svh"

module ctu_unit #(
    parameter int SLOT_BITS = 5,            // contexts: 1 << SLOT_BITS at most
    parameter int ADDRESS_BITS = 40,
    parameter int LINE_BYTES = 128,
    parameter int DESIGN = `CTU_DESIGN_PROJECTION,
    parameter int R = 4,
    parameter int R_RAY = 4,
    parameter int ENTRIES = 0,              // of the compression LUT; 0: object masks are not compressed
    parameter int ROWS = `CTU_ROWS_ALL,     // of the tables
    parameter int DISTINCT = 1270,          // rows of dedup's second memory
    parameter int PROJECTION_TABLES = 3,
    parameter int BANKS = 4,
    parameter int PORTS = 1,
    parameter int UNITS = 1,                // lanes located at once
    parameter int NODE_PORTS = 1,
    parameter int LEAF_PORTS = 1,
    parameter bit TABLE_CACHE = 1'b0,       // of designs that have tables only
    parameter int TABLE_PORTS = 1,
    parameter int BOX_BITS = 32,            // of a coordinate of the image's boxes: 32, or 16, 12, 8
    parameter bit PRIMITIVE_BOXES = 1'b0,   // the image has them
    parameter bit SPHERES = 1'b0,           // the image has some
    parameter int CULL_UNITS = 1,           // boxes of primitives compared at once
    parameter int PACKETS = 0,              // of rays, under way at once at most; 0: rays travel alone
    parameter int PACKET_ENTRIES = 16,      // PACKETS: of a packet at most, 1 .. 16
    parameter int MIN_PACKET_INTERVAL = 4,  // PACKETS
    parameter int TREES = 1,                // of the image, 1 .. 256; a ray walks one of them
    parameter int STACK_ENTRIES = 16,       // of a context on chip, a power of two
    parameter bit HAS_SPILLS = 1'b1,
    parameter int MAX_SETS = 128,           // of each cache
    parameter int MAX_WAYS = 4,
    parameter int MAX_MSHRS = 16,
    parameter int MAX_HIT_LATENCY = 3,
    parameter int MAX_LEAF_BYTES = 160,
    parameter int RAY_SETUP_LATENCY = 20,
    parameter int MIN_RAY_INTERVAL = 3,
    parameter int DECODE_LATENCY = 5,       // BOX_BITS below 32
    parameter int BOX_LATENCY = 11,
    parameter int LOCATE_LATENCY = 10,
    parameter int MASK_LATENCY = 2,
    parameter int MASK_SECOND_LATENCY = 1,  // dedup
    parameter int SORT_LATENCY = 3,
    parameter int CULL_LATENCY = 10,        // PRIMITIVE_BOXES
    parameter int PACKET_LATENCY = 12,      // PACKETS
    parameter int TRIANGLE_LATENCY = 45,
    parameter int SPHERE_LATENCY = 89,      // SPHERES
    parameter int HIT_LATENCY = 2,
    parameter int LOAD_BITS = `CTU_LOAD_BITS(DESIGN, R, ENTRIES),  // of a table's row at the load port
    localparam int SET_BITS = MAX_SETS == 1 ? 1 : $clog2(MAX_SETS),
    localparam int WAY_BITS = $clog2(MAX_WAYS + 1),
    localparam int MSHR_BITS = $clog2(MAX_MSHRS + 1),
    localparam int HIT_LATENCY_BITS = $clog2(MAX_HIT_LATENCY + 1),
    localparam int CLIENTS = TABLE_CACHE ? 4 : HAS_SPILLS ? 3 : 2,
    localparam int PACKET_BITS = PACKETS <= 2 ? 1 : $clog2(PACKETS),
    localparam int TREE_BITS = TREES <= 2 ? 1 : $clog2(TREES)
) (
    input logic clk_i,
    input logic rst_i,

    // Straps.
    input logic [         SLOT_BITS:0] contexts_i,           // in use
    input logic [                 6:0] ray_interval_i,
    input logic [       PACKET_BITS:0] packets_i,            // in use
    input logic [                 4:0] packet_entries_i,     // of a packet at most
    input logic [                 6:0] packet_interval_i,
    input logic                        round_robin_i,
    input logic [        SET_BITS-1:0] node_set_mask_i,
    input logic [        WAY_BITS-1:0] node_ways_i,
    input logic [       MSHR_BITS-1:0] node_mshrs_i,
    input logic [HIT_LATENCY_BITS-1:0] node_hit_latency_i,
    input logic [        SET_BITS-1:0] leaf_set_mask_i,
    input logic [        WAY_BITS-1:0] leaf_ways_i,
    input logic [       MSHR_BITS-1:0] leaf_mshrs_i,
    input logic [HIT_LATENCY_BITS-1:0] leaf_hit_latency_i,
    input logic [        SET_BITS-1:0] table_set_mask_i,
    input logic [        WAY_BITS-1:0] table_ways_i,
    input logic [       MSHR_BITS-1:0] table_mshrs_i,
    input logic [HIT_LATENCY_BITS-1:0] table_hit_latency_i,
    input logic [  4*ADDRESS_BITS-1:0] table_base_i,         // of each table, the first one lowest
    input logic [                 3:0] bit_row_shift_i,      // a bit row takes 1 << this bytes in memory
    input logic [    ADDRESS_BITS-1:0] node_base_i,
    input logic [                12:0] node_stride_i,
    input logic [                30:0] masked_nodes_i,
    input logic [    ADDRESS_BITS-1:0] bare_base_i,
    input logic [                12:0] bare_stride_i,
    input logic [                11:0] full_index_i,         // of compressed masks: the last one, which is full
    input logic [    ADDRESS_BITS-1:0] triangle_base_i,
    input logic [                12:0] triangle_stride_i,
    input logic [                 6:0] triangle_interval_i,
    input logic [                 9:0] result_interval_i,
    input logic [                 6:0] stack_entries_i,
    input logic [                 1:0] push_width_i,
    input logic [                 6:0] spill_batch_i,
    input logic [    ADDRESS_BITS-1:0] spill_base_i,
    input logic [    ADDRESS_BITS-1:0] spill_region_i,

    // Feed: the next ray; taken with ray_take_o, into context ray_slot_o.
    input  logic                 ray_valid_i,
    input  logic [         95:0] ray_origin_i,
    input  logic [         95:0] ray_direction_i,
    input  logic [         31:0] ray_tmin_i,
    input  logic [         31:0] ray_tmax_i,
    input  logic                 ray_any_hit_i,
    input  logic                 ray_closes_i,      // with PACKETS: it is the last one of its packet
    input  logic [TREE_BITS-1:0] ray_tree_i,        // with TREES above 1: the number of its tree
    output logic                 ray_take_o,
    output logic [SLOT_BITS-1:0] ray_slot_o,

    // Return: the hit of the ray in a context; always taken.
    output logic                 return_valid_o,
    output logic [SLOT_BITS-1:0] return_slot_o,
    output logic [        127:0] return_hit_o,  // {t, u, v, primitive}

    // Memory.
    input  logic [             CLIENTS-1:0] mem_can_accept_i,     // it takes the request that the client shows
    output logic [             CLIENTS-1:0] mem_asked_o,
    output logic [CLIENTS*ADDRESS_BITS-1:0] mem_address_o,
    output logic                            mem_request_valid_o,
    output logic [                     1:0] mem_request_client_o,
    output logic [        ADDRESS_BITS-1:0] mem_request_address_o,
    output logic [                     7:0] mem_request_id_o,
    output logic                            mem_request_write_o,
    output logic [        8*LINE_BYTES-1:0] mem_request_data_o,
    input  logic                            mem_answer_valid_i,
    input  logic [                     1:0] mem_answer_client_i,
    input  logic [                     7:0] mem_answer_id_i,
    input  logic [        8*LINE_BYTES-1:0] mem_answer_data_i,
    output logic                            mem_answer_take_o,
    input  logic                            mem_busy_i,           // something is under way in it

    // Tables, filled before rays come.
    input logic                 load_valid_i,
    input logic [          1:0] load_table_i,
    input logic [         27:0] load_row_i,
    input logic [LOAD_BITS-1:0] load_data_i,
    input logic                 root_write_i,
    input logic [TREE_BITS-1:0] root_tree_i,
    input logic [         31:0] root_i,

    // A ray needs a row that ROWS leaves out: its hit is not to be used.
    output logic                 row_left_out_o,
    output logic [SLOT_BITS-1:0] row_left_out_slot_o,

    // Accounts of the stages, in the order of links.svh.
    output logic [4*`CTU_STAGES-1:0] activity_o,

    // For tests: bit l makes link l refuse; tied low in a chip.
    input logic [`CTU_LINKS-1:0] stall_push_i,
    input logic [`CTU_LINKS-1:0] stall_pop_i
);
  localparam bit HAS_MASK_TEST = DESIGN != `CTU_DESIGN_NONE;
  localparam int COMPARATORS = DESIGN == `CTU_DESIGN_COMPARATORS ? 1 : 0;
  localparam int CELLS = R * R * R;
  localparam int INDEX_BITS = ENTRIES > 1 ? $clog2(ENTRIES) : 1;
  // Of a lane's mask in the image, and as it lies there, in whole bytes.
  localparam int MASK_BITS = !HAS_MASK_TEST ? 0 : ENTRIES > 0 ? INDEX_BITS : CELLS;
  localparam int LANE_BITS = MASK_BITS == 0 ? 1 : MASK_BITS;
  localparam int LANE_BYTES = (MASK_BITS + 7) / 8;
  localparam int BOXES_BITS = BOX_BITS == 32 ? 768 : 128 + 24 * BOX_BITS;
  localparam int NODE_BYTES = BOXES_BITS / 8 + 16 + 4 * LANE_BYTES;
  localparam int KEY_BITS = COMPARATORS != 0 ? CELLS : 31;
  localparam int FETCHED_BITS = TABLE_CACHE ? `CTU_FETCHED_BITS(DESIGN, R, ENTRIES, ROWS) : 1;

  localparam int REF = SLOT_BITS + 32;
  localparam bit HAS_PACKETS = PACKETS != 0;
  localparam int NODE_REF = HAS_PACKETS ? REF + 1 : REF;  // with whether it is a packet's
  localparam int NODE = SLOT_BITS + `CTU_NODE_FIELDS;
  localparam int TESTED = SLOT_BITS + `CTU_TESTED_FIELDS;
  localparam int REQUEST = ADDRESS_BITS + `CTU_ID_BITS + 1;  // without data
  localparam int LINE = 8 * LINE_BYTES;
  localparam int RESPONSE = `CTU_ID_BITS + LINE;

  // Links: their two sides by number, their data by name.
  logic [`CTU_LINKS-1:0] valid, ready, push, pop;

`define CTU_LINK(NAME, NUMBER, BITS) \
  logic [BITS-1:0] NAME``_in, NAME``_out; \
  link #( \
      .WIDTH(BITS) \
  ) NAME ( \
      .clk_i, \
      .rst_i, \
      .stall_push_i(stall_push_i[NUMBER]), \
      .stall_pop_i(stall_pop_i[NUMBER]), \
      .push_i(push[NUMBER]), \
      .data_i(NAME``_in), \
      .ready_o(ready[NUMBER]), \
      .pop_i(pop[NUMBER]), \
      .valid_o(valid[NUMBER]), \
      .data_o(NAME``_out) \
  );
  // The bits of a link that is left out.
`define CTU_NO_LINK(NUMBER) \
  assign valid[NUMBER] = 1'b0; \
  assign ready[NUMBER] = 1'b0; \
  assign push[NUMBER] = 1'b0; \
  assign pop[NUMBER] = 1'b0;

  `CTU_LINK(ray_to_result, `CTU_RAY_TO_RESULT, SLOT_BITS)
  `CTU_LINK(result_to_ray, `CTU_RESULT_TO_RAY, SLOT_BITS)
  `CTU_LINK(scheduler_to_node, `CTU_SCHEDULER_TO_NODE, NODE_REF)
  `CTU_LINK(scheduler_to_leaf, `CTU_SCHEDULER_TO_LEAF, REF)
  `CTU_LINK(node_to_box, `CTU_NODE_TO_BOX, REF)
  `CTU_LINK(sort_to_stack, `CTU_SORT_TO_STACK, NODE)
  `CTU_LINK(hit_to_stack, `CTU_HIT_TO_STACK, SLOT_BITS + 1)
  `CTU_LINK(stack_to_scheduler, `CTU_STACK_TO_SCHEDULER, REF)
  `CTU_LINK(stack_to_result, `CTU_STACK_TO_RESULT, SLOT_BITS)
  `CTU_LINK(node_to_memory, `CTU_NODE_TO_MEMORY, REQUEST)
  `CTU_LINK(memory_to_node, `CTU_MEMORY_TO_NODE, RESPONSE)
  `CTU_LINK(leaf_to_memory, `CTU_LEAF_TO_MEMORY, REQUEST)
  `CTU_LINK(memory_to_leaf, `CTU_MEMORY_TO_LEAF, RESPONSE)
  // Rays by context. What the host gives is written as ray_queue takes a ray, what it computes as the ray leaves it. Read
  // by box_test, cell_locate, triangle_test and hit_update; and where they are there by primitive_cull and sphere_test,
  // the two leaf readers, first one lowest, which also want the whole direction; and by packet_cull above these.
  logic [SLOT_BITS-1:0] boxes_slot, box_slot, locate_slot, triangle_ray_slot, hit_slot, join_slot;
  localparam int LEAF_READERS = 32'(PRIMITIVE_BOXES) + 32'(SPHERES);
  localparam int LEAF_FILES = LEAF_READERS == 0 ? 1 : LEAF_READERS;  // no vector is empty
  localparam int SPHERE_READER = 32'(PRIMITIVE_BOXES);
  logic [LEAF_FILES*SLOT_BITS-1:0] leaf_reader_slot;

  localparam int ORIGIN = 0;
  localparam int TMIN = 96;
  localparam int DIRECTION_Z = 128;
  localparam int KX = 160;
  localparam int KY = 162;
  localparam int KZ = 164;
  localparam int ZERO_AXES = 166;
  localparam int NEGATIVE_AXES = 169;
  localparam int ANY_HIT = 172;
  localparam int RAY = 173;
  logic [1:0] ray_kx, ray_ky, ray_kz;
  logic [2:0] ray_zero_axes, ray_negative_axes;
  logic [31:0] ray_direction_z;
  localparam int RAY_READS = 4 + LEAF_FILES + 32'(HAS_PACKETS);
  logic [RAY-1:0] box_ray, locate_ray, triangle_ray, hit_ray;
  logic [LEAF_FILES*RAY-1:0] leaf_ray;
  logic [RAY_READS*RAY-1:0] rays_read;
  assign ray_direction_z = ray_direction_i[32*ray_kz+:32];
  context_file #(
      .WIDTH(RAY),
      .SLOT_BITS(SLOT_BITS),
      .READS(RAY_READS)
  ) rays (
      .clk_i,
      .write_i(ray_take_o),
      .write_slot_i(ray_slot_o),
      .write_data_i({ray_any_hit_i, ray_negative_axes, ray_zero_axes, ray_kz, ray_ky, ray_kx, ray_direction_z,
                     ray_tmin_i, ray_origin_i}),
      .read_slot_i((RAY_READS*SLOT_BITS)'({join_slot, leaf_reader_slot, hit_slot, triangle_ray_slot, locate_slot, box_slot})),
      .read_data_o(rays_read)
  );
  assign {leaf_ray, hit_ray, triangle_ray, locate_ray, box_ray} = rays_read[0+:(4+LEAF_FILES)*RAY];

  localparam int RCP_DOWN = 0;
  localparam int RCP_UP = 96;
  localparam int SX = 192;
  localparam int SY = 224;
  localparam int SETUP = 256;
  logic setup_write;
  logic [SLOT_BITS-1:0] setup_slot;
  logic [95:0] setup_rcp_down, setup_rcp_up;
  logic [31:0] setup_sx, setup_sy;
  localparam int SETUP_READS = 2 + 32'(HAS_PACKETS);
  logic [SETUP-1:0] box_setup, triangle_setup;
  logic [SETUP_READS*SETUP-1:0] setups_read;
  context_file #(
      .WIDTH(SETUP),
      .SLOT_BITS(SLOT_BITS),
      .READS(SETUP_READS)
  ) ray_setups (
      .clk_i,
      .write_i(setup_write),
      .write_slot_i(setup_slot),
      .write_data_i({setup_sy, setup_sx, setup_rcp_up, setup_rcp_down}),
      .read_slot_i((SETUP_READS*SLOT_BITS)'({join_slot, triangle_ray_slot, box_slot})),
      .read_data_o(setups_read)
  );
  assign {triangle_setup, box_setup} = setups_read[0+:2*SETUP];

  // Best hits by context, {t, u, v, primitive}: written by ray_queue and hit_update; read by box_test, triangle_test,
  // hit_update, traversal_stack, the leaf readers, packet_cull and for the host.
  logic best_write;
  logic [SLOT_BITS-1:0] triangle_best_slot, stack_slot;
  logic [127:0] best_written, box_best, triangle_best, hit_best, stack_best;
  logic [LEAF_FILES*128-1:0] leaf_best;
  localparam int BEST_READS = 5 + LEAF_FILES + 32'(HAS_PACKETS);
  logic [BEST_READS*128-1:0] bests_read;
  context_file #(
      .WIDTH(128),
      .SLOT_BITS(SLOT_BITS),
      .WRITES(2),
      .READS(BEST_READS)
  ) best_hits (
      .clk_i,
      .write_i({best_write, ray_take_o}),
      .write_slot_i({hit_slot, ray_slot_o}),
      .write_data_i({best_written, ray_tmax_i, 64'd0, 32'hffffffff}),
      .read_slot_i((BEST_READS*SLOT_BITS)'({join_slot, leaf_reader_slot, return_slot_o, stack_slot, hit_slot,
                                            triangle_best_slot, box_slot})),
      .read_data_o(bests_read)
  );
  assign {leaf_best, return_hit_o, stack_best, hit_best, triangle_best, box_best} = bests_read[0+:(5+LEAF_FILES)*128];

  // Entry times of the four lanes by context: written by box_test; read by child_sort and traversal_stack. The other
  // times of the slab test are there only for cell_locate, t1 for traversal_stack where primitive_cull wants it.
  logic times_write;
  logic [SLOT_BITS-1:0] times_write_slot, sort_slot;
  logic [127:0] t0_written, t1_written, sort_t0, stack_t0, locate_t0;
  logic [383:0] near_down_written, near_up_written, far_down_written, far_up_written;
  context_file #(
      .WIDTH(128),
      .SLOT_BITS(SLOT_BITS),
      .READS(3)
  ) entry_times (
      .clk_i,
      .write_i(times_write),
      .write_slot_i(times_write_slot),
      .write_data_i(t0_written),
      .read_slot_i({locate_slot, stack_slot, sort_slot}),
      .read_data_o({locate_t0, stack_t0, sort_t0})
  );

  // Roots by context, where there are several: written as ray_queue takes a ray; read as it leaves there or, where rays
  // travel in packets, as it joins one.
  logic [31:0] ray_root, context_root;
  generate
    if (TREES > 1) begin : g_roots
      context_file #(
          .WIDTH(32),
          .SLOT_BITS(SLOT_BITS)
      ) roots (
          .clk_i,
          .write_i(ray_take_o),
          .write_slot_i(ray_slot_o),
          .write_data_i(ray_root),
          .read_slot_i(HAS_PACKETS ? join_slot : setup_slot),
          .read_data_o(context_root)
      );
    end else begin : g_root
      assign context_root = ray_root;
    end
  endgenerate

  logic queued_ready, queued_push, joining_ready, joining_push;
  logic [REF-1:0] queued;
  logic [SLOT_BITS+1:0] joining;
  ray_queue #(
      .SLOT_BITS(SLOT_BITS),
      .LATENCY(RAY_SETUP_LATENCY),
      .MIN_INTERVAL(MIN_RAY_INTERVAL),
      .PACKETS(HAS_PACKETS),
      .TREES(TREES)
  ) ray_queue_stage (
      .clk_i,
      .rst_i,
      .contexts_i,
      .interval_i(ray_interval_i),
      .root_write_i,
      .root_tree_i,
      .root_i,
      .ray_valid_i,
      .ray_origin_i,
      .ray_direction_i,
      .ray_tmin_i,
      .ray_tmax_i,
      .ray_closes_i,
      .ray_tree_i,
      .ray_take_o,
      .ray_slot_o,
      .ray_root_o(ray_root),
      .ray_zero_axes_o(ray_zero_axes),
      .ray_negative_axes_o(ray_negative_axes),
      .ray_kx_o(ray_kx),
      .ray_ky_o(ray_ky),
      .ray_kz_o(ray_kz),
      .freed_valid_i(valid[`CTU_RESULT_TO_RAY]),
      .freed_data_i(result_to_ray_out),
      .freed_pop_o(pop[`CTU_RESULT_TO_RAY]),
      .to_scheduler_ready_i(queued_ready),
      .to_scheduler_push_o(queued_push),
      .to_scheduler_data_o(queued),
      .to_result_ready_i(ready[`CTU_RAY_TO_RESULT]),
      .to_result_push_o(push[`CTU_RAY_TO_RESULT]),
      .to_result_data_o(ray_to_result_in),
      .to_packets_ready_i(joining_ready),
      .to_packets_push_o(joining_push),
      .to_packets_data_o(joining),
      .setup_write_o(setup_write),
      .setup_slot_o(setup_slot),
      .setup_rcp_down_o(setup_rcp_down),
      .setup_rcp_up_o(setup_rcp_up),
      .setup_sx_o(setup_sx),
      .setup_sy_o(setup_sy),
      .setup_root_i(context_root),
      .activity_o(activity_o[4*`CTU_RAY_QUEUE+:4])
  );

  // To the scheduler come rays, or packets' nodes; the links of packet_cull are there with it.
  logic begins_valid, begins_pop, packet_node_ready, packet_node_push, starts_valid, starts_pop;
  logic released_ready, released_push;
  logic [REF-1:0] begins;
  logic [SLOT_BITS+PACKET_BITS:0] starts;
  logic [PACKET_BITS-1:0] released, stack_packet;
  logic [64*PACKET_ENTRIES-1:0] packet_entries;
  logic [4:0] packet_count;
  logic [SLOT_BITS-1:0] packet_boxes_slot, packet_children_slot;
  scheduler #(
      .SLOT_BITS(SLOT_BITS),
      .PACKETS(HAS_PACKETS)
  ) scheduler_stage (
      .clk_i,
      .rst_i,
      .policy_round_robin_i(round_robin_i),
      .from_stack_valid_i(valid[`CTU_STACK_TO_SCHEDULER]),
      .from_stack_data_i(stack_to_scheduler_out),
      .from_stack_pop_o(pop[`CTU_STACK_TO_SCHEDULER]),
      .from_rays_valid_i(begins_valid),
      .from_rays_data_i(begins),
      .from_rays_pop_o(begins_pop),
      .to_node_fetch_ready_i(ready[`CTU_SCHEDULER_TO_NODE]),
      .to_node_fetch_push_o(push[`CTU_SCHEDULER_TO_NODE]),
      .to_node_fetch_data_o(scheduler_to_node_in),
      .to_leaf_fetch_ready_i(ready[`CTU_SCHEDULER_TO_LEAF]),
      .to_leaf_fetch_push_o(push[`CTU_SCHEDULER_TO_LEAF]),
      .to_leaf_fetch_data_o(scheduler_to_leaf_in),
      .activity_o(activity_o[4*`CTU_SCHEDULER+:4])
  );

  // Readers of a node, first one lowest: box_test, traversal_stack, cell_locate, mask_test; table_fetch, of indices; above
  // all packet_cull, of boxes and of children.
  localparam bit FETCHES_BY_INDEX = TABLE_CACHE && ENTRIES > 0;
  localparam int RAY_READERS = FETCHES_BY_INDEX ? 5 : HAS_MASK_TEST ? 4 : 2;  // of rays' nodes
  localparam int NODE_READERS = HAS_PACKETS ? RAY_READERS + 2 : RAY_READERS;
  logic [NODE_READERS*SLOT_BITS-1:0] node_slot;
  logic [NODE_READERS*BOXES_BITS-1:0] node_boxes;
  logic [NODE_READERS*128-1:0] node_children;
  logic [NODE_READERS*4*LANE_BITS-1:0] node_masks;
  logic [NODE_READERS*4-1:0] node_full;
  assign node_slot[0+:2*SLOT_BITS] = {stack_slot, boxes_slot};
  node_fetch #(
      .SLOT_BITS(SLOT_BITS),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(LINE_BYTES),
      .PORTS(NODE_PORTS),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS),
      .MAX_MSHRS(MAX_MSHRS),
      .MAX_HIT_LATENCY(MAX_HIT_LATENCY),
      .MASK_BITS(MASK_BITS),
      .MAX_STRIDE(NODE_BYTES),
      .BOX_BITS(BOX_BITS),
      .READ_PORTS(NODE_READERS),
      .PACKETS(HAS_PACKETS)
  ) node_fetch_stage (
      .clk_i,
      .rst_i,
      .set_mask_i(node_set_mask_i),
      .ways_i(node_ways_i),
      .mshrs_i(node_mshrs_i),
      .hit_latency_i(node_hit_latency_i),
      .node_base_i,
      .node_stride_i,
      .masked_nodes_i,
      .bare_base_i,
      .bare_stride_i,
      .full_mask_i(ENTRIES > 0 ? LANE_BITS'(full_index_i) : {LANE_BITS{1'b1}}),
      .requests_valid_i(valid[`CTU_SCHEDULER_TO_NODE]),
      .requests_data_i(scheduler_to_node_out),
      .requests_pop_o(pop[`CTU_SCHEDULER_TO_NODE]),
      .fills_valid_i(valid[`CTU_MEMORY_TO_NODE]),
      .fills_data_i(memory_to_node_out),
      .fills_pop_o(pop[`CTU_MEMORY_TO_NODE]),
      .misses_ready_i(ready[`CTU_NODE_TO_MEMORY]),
      .misses_push_o(push[`CTU_NODE_TO_MEMORY]),
      .misses_data_o(node_to_memory_in),
      .done_ready_i(ready[`CTU_NODE_TO_BOX]),
      .done_push_o(push[`CTU_NODE_TO_BOX]),
      .done_data_o(node_to_box_in),
      .packets_ready_i(packet_node_ready),
      .packets_push_o(packet_node_push),
      .activity_o(activity_o[4*`CTU_NODE_FETCH+:4]),
      .node_slot_i(node_slot),
      .node_boxes_o(node_boxes),
      .node_children_o(node_children),
      .node_masks_o(node_masks),
      .node_full_o(node_full)
  );

  generate
    if (HAS_PACKETS) begin : g_packets
      `CTU_LINK(ray_to_packet, `CTU_RAY_TO_PACKET, SLOT_BITS + 2)
      `CTU_LINK(packet_to_scheduler, `CTU_PACKET_TO_SCHEDULER, REF)
      `CTU_LINK(node_to_packet, `CTU_NODE_TO_PACKET, REF)
      `CTU_LINK(packet_to_stack, `CTU_PACKET_TO_STACK, SLOT_BITS + PACKET_BITS + 1)
      `CTU_LINK(stack_to_packet, `CTU_STACK_TO_PACKET, PACKET_BITS)
      `CTU_NO_LINK(`CTU_RAY_TO_SCHEDULER)
      assign joining_ready = ready[`CTU_RAY_TO_PACKET];
      assign push[`CTU_RAY_TO_PACKET] = joining_push;
      assign ray_to_packet_in = joining;
      assign queued_ready = 1'b0;
      assign begins_valid = valid[`CTU_PACKET_TO_SCHEDULER];
      assign begins = packet_to_scheduler_out;
      assign pop[`CTU_PACKET_TO_SCHEDULER] = begins_pop;
      assign packet_node_ready = ready[`CTU_NODE_TO_PACKET];
      assign push[`CTU_NODE_TO_PACKET] = packet_node_push;
      assign node_to_packet_in = node_to_box_in;
      assign starts_valid = valid[`CTU_PACKET_TO_STACK];
      assign starts = packet_to_stack_out;
      assign pop[`CTU_PACKET_TO_STACK] = starts_pop;
      assign released_ready = ready[`CTU_STACK_TO_PACKET];
      assign push[`CTU_STACK_TO_PACKET] = released_push;
      assign stack_to_packet_in = released;

      localparam int BOXES_READER = RAY_READERS;
      localparam int CHILDREN_READER = RAY_READERS + 1;
      assign node_slot[RAY_READERS*SLOT_BITS+:2*SLOT_BITS] = {packet_children_slot, packet_boxes_slot};
      logic [3:0] packet_empty;
      for (genvar lane = 0; lane < 4; lane++) begin : g_empty
        assign packet_empty[lane] = node_children[128*BOXES_READER+32*lane+:32] == 32'hffffffff;
      end
      packet_cull #(
          .SLOT_BITS(SLOT_BITS),
          .PACKETS(PACKETS),
          .ENTRIES(PACKET_ENTRIES),
          .LATENCY(PACKET_LATENCY),
          .MIN_INTERVAL(MIN_PACKET_INTERVAL),
          .BOX_BITS(BOX_BITS),
          .DECODE_LATENCY(DECODE_LATENCY),
          .TREES(TREES)
      ) packet_cull_stage (
          .clk_i,
          .rst_i,
          .packets_i,
          .most_entries_i(packet_entries_i),
          .interval_i(packet_interval_i),
          .rays_valid_i(valid[`CTU_RAY_TO_PACKET]),
          .rays_data_i(ray_to_packet_out),
          .rays_pop_o(pop[`CTU_RAY_TO_PACKET]),
          .nodes_valid_i(valid[`CTU_NODE_TO_PACKET]),
          .nodes_data_i(node_to_packet_out),
          .nodes_pop_o(pop[`CTU_NODE_TO_PACKET]),
          .released_valid_i(valid[`CTU_STACK_TO_PACKET]),
          .released_data_i(stack_to_packet_out),
          .released_pop_o(pop[`CTU_STACK_TO_PACKET]),
          .to_scheduler_ready_i(ready[`CTU_PACKET_TO_SCHEDULER]),
          .to_scheduler_push_o(push[`CTU_PACKET_TO_SCHEDULER]),
          .to_scheduler_data_o(packet_to_scheduler_in),
          .starts_ready_i(ready[`CTU_PACKET_TO_STACK]),
          .starts_push_o(push[`CTU_PACKET_TO_STACK]),
          .starts_data_o(packet_to_stack_in),
          .ray_slot_o(join_slot),
          .ray_origin_i(rays_read[(RAY_READS-1)*RAY+ORIGIN+:96]),
          .ray_rcp_down_i(setups_read[(SETUP_READS-1)*SETUP+RCP_DOWN+:96]),
          .ray_rcp_up_i(setups_read[(SETUP_READS-1)*SETUP+RCP_UP+:96]),
          .ray_zero_axes_i(rays_read[(RAY_READS-1)*RAY+ZERO_AXES+:3]),
          .ray_negative_axes_i(rays_read[(RAY_READS-1)*RAY+NEGATIVE_AXES+:3]),
          .ray_tmin_i(rays_read[(RAY_READS-1)*RAY+TMIN+:32]),
          .ray_tmax_i(bests_read[(BEST_READS-1)*128+96+:32]),
          .ray_root_i(context_root),
          .boxes_slot_o(packet_boxes_slot),
          .boxes_i(node_boxes[BOXES_BITS*BOXES_READER+:BOXES_BITS]),
          .empty_i(packet_empty),
          .children_slot_o(packet_children_slot),
          .children_i(node_children[128*CHILDREN_READER+:128]),
          .entries_packet_i(stack_packet),
          .entries_o(packet_entries),
          .count_packet_i(starts[1+:PACKET_BITS]),
          .count_o(packet_count),
          .activity_o(activity_o[4*`CTU_PACKET_CULL+:4])
      );
    end else begin : g_no_packets
      `CTU_LINK(ray_to_scheduler, `CTU_RAY_TO_SCHEDULER, REF)
      `CTU_NO_LINK(`CTU_RAY_TO_PACKET)
      `CTU_NO_LINK(`CTU_PACKET_TO_SCHEDULER)
      `CTU_NO_LINK(`CTU_NODE_TO_PACKET)
      `CTU_NO_LINK(`CTU_PACKET_TO_STACK)
      `CTU_NO_LINK(`CTU_STACK_TO_PACKET)
      assign queued_ready = ready[`CTU_RAY_TO_SCHEDULER];
      assign push[`CTU_RAY_TO_SCHEDULER] = queued_push;
      assign ray_to_scheduler_in = queued;
      assign begins_valid = valid[`CTU_RAY_TO_SCHEDULER];
      assign begins = ray_to_scheduler_out;
      assign pop[`CTU_RAY_TO_SCHEDULER] = begins_pop;
      assign joining_ready = 1'b0;
      assign packet_node_ready = 1'b0;
      assign starts_valid = 1'b0;
      assign starts = '0;
      assign released_ready = 1'b0;
      assign packet_entries = '0;
      assign packet_count = '0;
      assign join_slot = '0;
      assign activity_o[4*`CTU_PACKET_CULL+:4] = `CTU_IDLE;
      wire unused_packets = &{1'b0, packets_i, packet_entries_i, packet_interval_i};
    end
  endgenerate

  logic tested_push, tested_ready, decoded_write;
  logic [767:0] decoded_written;
  logic [3:0] box_empty;
  generate
    for (genvar lane = 0; lane < 4; lane++) begin : g_empty
      assign box_empty[lane] = node_children[32*lane+:32] == 32'hffffffff;
    end
  endgenerate
  logic [NODE-1:0] tested;
  box_test #(
      .SLOT_BITS(SLOT_BITS),
      .LATENCY(BOX_LATENCY),
      .INNER(HAS_MASK_TEST),
      .BOX_BITS(BOX_BITS),
      .DECODE_LATENCY(DECODE_LATENCY)
  ) box_test_stage (
      .clk_i,
      .rst_i,
      .node_valid_i(valid[`CTU_NODE_TO_BOX]),
      .node_data_i(node_to_box_out),
      .node_pop_o(pop[`CTU_NODE_TO_BOX]),
      .tested_ready_i(tested_ready),
      .tested_push_o(tested_push),
      .tested_data_o(tested),
      .boxes_slot_o(boxes_slot),
      .boxes_i(node_boxes[0+:BOXES_BITS]),
      .empty_i(box_empty),
      .ray_slot_o(box_slot),
      .ray_origin_i(box_ray[ORIGIN+:96]),
      .ray_rcp_down_i(box_setup[RCP_DOWN+:96]),
      .ray_rcp_up_i(box_setup[RCP_UP+:96]),
      .ray_zero_axes_i(box_ray[ZERO_AXES+:3]),
      .ray_negative_axes_i(box_ray[NEGATIVE_AXES+:3]),
      .ray_tmin_i(box_ray[TMIN+:32]),
      .best_t_i(box_best[96+:32]),
      .decoded_write_o(decoded_write),
      .decoded_boxes_o(decoded_written),
      .times_write_o(times_write),
      .times_slot_o(times_write_slot),
      .times_near_down_o(near_down_written),
      .times_near_up_o(near_up_written),
      .times_far_down_o(far_down_written),
      .times_far_up_o(far_up_written),
      .times_t0_o(t0_written),
      .times_t1_o(t1_written),
      .activity_o(activity_o[4*`CTU_BOX_TEST+:4])
  );

  // From the lanes hit to those that pass.
  logic survivors_valid, survivors_pop;
  logic [NODE-1:0] survivors;
  generate
    if (HAS_MASK_TEST) begin : g_culling
      `CTU_LINK(box_to_locate, `CTU_BOX_TO_LOCATE, NODE)
      `CTU_LINK(mask_to_sort, `CTU_MASK_TO_SORT, NODE)
      `CTU_NO_LINK(`CTU_BOX_TO_SORT)
      assign push[`CTU_BOX_TO_LOCATE] = tested_push;
      assign box_to_locate_in = tested;
      assign tested_ready = ready[`CTU_BOX_TO_LOCATE];
      assign survivors_valid = valid[`CTU_MASK_TO_SORT];
      assign survivors = mask_to_sort_out;
      assign pop[`CTU_MASK_TO_SORT] = survivors_pop;

      localparam int TIMES = 4 * 384 + 128;
      logic [383:0] near_down, near_up, far_down, far_up;
      logic [127:0] t1;
      context_file #(
          .WIDTH(TIMES),
          .SLOT_BITS(SLOT_BITS)
      ) slab_times (
          .clk_i,
          .write_i(times_write),
          .write_slot_i(times_write_slot),
          .write_data_i({t1_written, far_up_written, far_down_written, near_up_written, near_down_written}),
          .read_slot_i(locate_slot),
          .read_data_o({t1, far_up, far_down, near_up, near_down})
      );

      // What is located goes to mask_test, or to table_fetch first.
      logic located_ready, located_push, fetched_valid, fetched_pop;
      logic [NODE-1:0] located, fetched;

      // Boxes for cell_locate: as node_fetch holds them, or as they were decoded.
      logic [767:0] locate_boxes;
      if (BOX_BITS == 32) begin : g_full_boxes
        assign locate_boxes = node_boxes[2*768+:768];
      end else begin : g_compact_boxes
        context_file #(
            .WIDTH(768),
            .SLOT_BITS(SLOT_BITS)
        ) decoded_boxes (
            .clk_i,
            .write_i(decoded_write),
            .write_slot_i(box_slot),
            .write_data_i(decoded_written),
            .read_slot_i(locate_slot),
            .read_data_o(locate_boxes)
        );
      end

      logic [SLOT_BITS-1:0] key_slot, mask_slot, key_write_slot;
      logic [UNITS-1:0] key_write;
      logic [2*UNITS-1:0] key_lane;
      logic [UNITS*KEY_BITS-1:0] keys_located;
      assign node_slot[2*SLOT_BITS+:2*SLOT_BITS] = {mask_slot, locate_slot};
      cell_locate #(
          .COMPARATORS(COMPARATORS),
          .R(R),
          .R_RAY(R_RAY),
          .UNITS(UNITS),
          .LATENCY(LOCATE_LATENCY),
          .SLOT_BITS(SLOT_BITS)
      ) cell_locate_stage (
          .clk_i,
          .rst_i,
          .tested_valid_i(valid[`CTU_BOX_TO_LOCATE]),
          .tested_data_i(box_to_locate_out),
          .tested_pop_o(pop[`CTU_BOX_TO_LOCATE]),
          .located_ready_i(located_ready),
          .located_push_o(located_push),
          .located_data_o(located),
          .context_slot_o(locate_slot),
          .times_near_down_i(near_down),
          .times_near_up_i(near_up),
          .times_far_down_i(far_down),
          .times_far_up_i(far_up),
          .times_t0_i(locate_t0),
          .times_t1_i(t1),
          .boxes_i(locate_boxes),
          .full_lanes_i(node_full[8+:4]),
          .ray_origin_i(locate_ray[ORIGIN+:96]),
          .ray_zero_axes_i(locate_ray[ZERO_AXES+:3]),
          .ray_negative_axes_i(locate_ray[NEGATIVE_AXES+:3]),
          .key_write_o(key_write),
          .key_slot_o(key_write_slot),
          .key_lane_o(key_lane),
          .key_o(keys_located),
          .activity_o(activity_o[4*`CTU_CELL_LOCATE+:4])
      );

      // Keys or touched cells by context, a file for each lane, as the lanes of a node are located one after the other.
      // Read by mask_test, and by table_fetch before it.
      localparam int KEY_READERS = TABLE_CACHE ? 2 : 1;
      logic [KEY_READERS*SLOT_BITS-1:0] key_slots;
      logic [4*KEY_READERS*KEY_BITS-1:0] keys_read;  // by lane
      logic [4*KEY_BITS-1:0] keys;
      assign key_slots[SLOT_BITS-1:0] = key_slot;
      assign row_left_out_slot_o = key_slot;  // keys are read in the cycle in which a row turns out to be left out
      for (genvar lane = 0; lane < 4; lane++) begin : g_keys
        logic [UNITS-1:0] write;
        for (genvar u = 0; u < UNITS; u++) begin : g_unit
          assign write[u] = key_write[u] && key_lane[2*u+:2] == 2'(lane);
        end
        context_file #(
            .WIDTH(KEY_BITS),
            .SLOT_BITS(SLOT_BITS),
            .WRITES(UNITS),
            .READS(KEY_READERS)
        ) file (
            .clk_i,
            .write_i(write),
            .write_slot_i({UNITS{key_write_slot}}),
            .write_data_i(keys_located),
            .read_slot_i(key_slots),
            .read_data_o(keys_read[KEY_READERS*KEY_BITS*lane+:KEY_READERS*KEY_BITS])
        );
        assign keys[KEY_BITS*lane+:KEY_BITS] = keys_read[KEY_READERS*KEY_BITS*lane+:KEY_BITS];
      end

      logic [SLOT_BITS-1:0] row_slot;
      logic [4*FETCHED_BITS-1:0] rows_fetched;
      if (TABLE_CACHE) begin : g_tables
        `CTU_LINK(locate_to_table, `CTU_LOCATE_TO_TABLE, NODE)
        `CTU_LINK(table_to_mask, `CTU_TABLE_TO_MASK, NODE)
        `CTU_LINK(table_to_memory, `CTU_TABLE_TO_MEMORY, REQUEST)
        `CTU_LINK(memory_to_table, `CTU_MEMORY_TO_TABLE, RESPONSE)
        `CTU_NO_LINK(`CTU_LOCATE_TO_MASK)
        assign located_ready = ready[`CTU_LOCATE_TO_TABLE];
        assign push[`CTU_LOCATE_TO_TABLE] = located_push;
        assign locate_to_table_in = located;
        assign fetched_valid = valid[`CTU_TABLE_TO_MASK];
        assign fetched = table_to_mask_out;
        assign pop[`CTU_TABLE_TO_MASK] = fetched_pop;

        localparam int INDICES = ENTRIES > 0 ? 4 * INDEX_BITS : 4;
        logic [SLOT_BITS-1:0] table_slot;
        logic [4*31-1:0] table_keys;
        logic [INDICES-1:0] indices;
        assign key_slots[SLOT_BITS+:SLOT_BITS] = table_slot;
        for (genvar lane = 0; lane < 4; lane++) begin : g_keys
          assign table_keys[31*lane+:31] = 31'(keys_read[KEY_BITS*(2*lane+1)+:KEY_BITS]);
        end
        if (FETCHES_BY_INDEX) begin : g_indices
          assign node_slot[4*SLOT_BITS+:SLOT_BITS] = table_slot;
          assign indices = node_masks[16*LANE_BITS+:4*LANE_BITS];
        end else begin : g_no_indices
          assign indices = '0;
        end
        table_fetch #(
            .DESIGN(DESIGN),
            .R(R),
            .R_RAY(R_RAY),
            .ENTRIES(ENTRIES),
            .ROWS(ROWS),
            .DISTINCT(DISTINCT),
            .PROJECTION_TABLES(PROJECTION_TABLES),
            .SLOT_BITS(SLOT_BITS),
            .ADDRESS_BITS(ADDRESS_BITS),
            .LINE_BYTES(LINE_BYTES),
            .PORTS(TABLE_PORTS),
            .MAX_SETS(MAX_SETS),
            .MAX_WAYS(MAX_WAYS),
            .MAX_MSHRS(MAX_MSHRS),
            .MAX_HIT_LATENCY(MAX_HIT_LATENCY)
        ) table_fetch_stage (
            .clk_i,
            .rst_i,
            .set_mask_i(table_set_mask_i),
            .ways_i(table_ways_i),
            .mshrs_i(table_mshrs_i),
            .hit_latency_i(table_hit_latency_i),
            .table_base_i,
            .bit_row_shift_i,
            .requests_valid_i(valid[`CTU_LOCATE_TO_TABLE]),
            .requests_data_i(locate_to_table_out),
            .requests_pop_o(pop[`CTU_LOCATE_TO_TABLE]),
            .fills_valid_i(valid[`CTU_MEMORY_TO_TABLE]),
            .fills_data_i(memory_to_table_out),
            .fills_pop_o(pop[`CTU_MEMORY_TO_TABLE]),
            .misses_ready_i(ready[`CTU_TABLE_TO_MEMORY]),
            .misses_push_o(push[`CTU_TABLE_TO_MEMORY]),
            .misses_data_o(table_to_memory_in),
            .done_ready_i(ready[`CTU_TABLE_TO_MASK]),
            .done_push_o(push[`CTU_TABLE_TO_MASK]),
            .done_data_o(table_to_mask_in),
            .activity_o(activity_o[4*`CTU_TABLE_FETCH+:4]),
            .key_slot_o(table_slot),
            .key_i(table_keys),
            .index_i(indices),
            .row_slot_i(row_slot),
            .row_o(rows_fetched)
        );
      end else begin : g_on_chip
        `CTU_LINK(locate_to_mask, `CTU_LOCATE_TO_MASK, NODE)
        assign located_ready = ready[`CTU_LOCATE_TO_MASK];
        assign push[`CTU_LOCATE_TO_MASK] = located_push;
        assign locate_to_mask_in = located;
        assign fetched_valid = valid[`CTU_LOCATE_TO_MASK];
        assign fetched = locate_to_mask_out;
        assign pop[`CTU_LOCATE_TO_MASK] = fetched_pop;
        assign rows_fetched = '0;
      end

      mask_test #(
          .DESIGN(DESIGN),
          .R(R),
          .R_RAY(R_RAY),
          .ENTRIES(ENTRIES),
          .DISTINCT(DISTINCT),
          .PROJECTION_TABLES(PROJECTION_TABLES),
          .BANKS(BANKS),
          .PORTS(PORTS),
          .ROWS(ROWS),
          .LATENCY(MASK_LATENCY),
          .SECOND_LATENCY(MASK_SECOND_LATENCY),
          .SLOT_BITS(SLOT_BITS),
          .CACHED(TABLE_CACHE)
      ) mask_test_stage (
          .clk_i,
          .rst_i,
          .located_valid_i(fetched_valid),
          .located_data_i(fetched),
          .located_pop_o(fetched_pop),
          .survivors_ready_i(ready[`CTU_MASK_TO_SORT]),
          .survivors_push_o(push[`CTU_MASK_TO_SORT]),
          .survivors_data_o(mask_to_sort_in),
          .key_slot_o(key_slot),
          .key_i(keys),
          .mask_slot_o(mask_slot),
          .mask_i(node_masks[12*LANE_BITS+:4*LANE_BITS]),
          .row_slot_o(row_slot),
          .row_i(rows_fetched),
          .load_valid_i,
          .load_table_i,
          .load_row_i,
          .load_data_i,
          .left_out_o(row_left_out_o),
          .activity_o(activity_o[4*`CTU_MASK_TEST+:4])
      );
    end else begin : g_no_culling
      `CTU_LINK(box_to_sort, `CTU_BOX_TO_SORT, NODE)
      `CTU_NO_LINK(`CTU_BOX_TO_LOCATE)
      `CTU_NO_LINK(`CTU_LOCATE_TO_MASK)
      `CTU_NO_LINK(`CTU_MASK_TO_SORT)
      assign push[`CTU_BOX_TO_SORT] = tested_push;
      assign box_to_sort_in = tested;
      assign tested_ready = ready[`CTU_BOX_TO_SORT];
      assign survivors_valid = valid[`CTU_BOX_TO_SORT];
      assign survivors = box_to_sort_out;
      assign pop[`CTU_BOX_TO_SORT] = survivors_pop;
      assign locate_slot = '0;
      assign row_left_out_o = 1'b0;
      assign row_left_out_slot_o = '0;
      assign activity_o[4*`CTU_CELL_LOCATE+:4] = `CTU_IDLE;
      assign activity_o[4*`CTU_MASK_TEST+:4] = `CTU_IDLE;
    end
  endgenerate

  child_sort #(
      .SLOT_BITS(SLOT_BITS),
      .LATENCY(SORT_LATENCY)
  ) child_sort_stage (
      .clk_i,
      .rst_i,
      .survivors_valid_i(survivors_valid),
      .survivors_data_i(survivors),
      .survivors_pop_o(survivors_pop),
      .sorted_ready_i(ready[`CTU_SORT_TO_STACK]),
      .sorted_push_o(push[`CTU_SORT_TO_STACK]),
      .sorted_data_o(sort_to_stack_in),
      .times_slot_o(sort_slot),
      .times_t0_i(sort_t0),
      .activity_o(activity_o[4*`CTU_CHILD_SORT+:4])
  );

  logic spills_ready, spills_push, refills_valid, refills_pop;
  logic [REQUEST+LINE-1:0] spills;
  logic [RESPONSE-1:0] refills;
  generate
    if (HAS_SPILLS) begin : g_spills
      `CTU_LINK(stack_to_memory, `CTU_STACK_TO_MEMORY, REQUEST + LINE)
      `CTU_LINK(memory_to_stack, `CTU_MEMORY_TO_STACK, RESPONSE)
      assign push[`CTU_STACK_TO_MEMORY] = spills_push;
      assign stack_to_memory_in = spills;
      assign spills_ready = ready[`CTU_STACK_TO_MEMORY];
      assign refills_valid = valid[`CTU_MEMORY_TO_STACK];
      assign refills = memory_to_stack_out;
      assign pop[`CTU_MEMORY_TO_STACK] = refills_pop;
    end else begin : g_no_spills
      `CTU_NO_LINK(`CTU_STACK_TO_MEMORY)
      `CTU_NO_LINK(`CTU_MEMORY_TO_STACK)
      assign spills_ready = 1'b0;
      assign refills_valid = 1'b0;
      assign refills = '0;
    end
  endgenerate
  logic [127:0] stack_t1;
  logic [31:0] stay_begin_written, stay_end_written, stay_begin, stay_end;
  generate
    if (PRIMITIVE_BOXES) begin : g_stays
      context_file #(
          .WIDTH(128),
          .SLOT_BITS(SLOT_BITS)
      ) exit_times (
          .clk_i,
          .write_i(times_write),
          .write_slot_i(times_write_slot),
          .write_data_i(t1_written),
          .read_slot_i(stack_slot),
          .read_data_o(stack_t1)
      );
      context_file #(
          .WIDTH(64),
          .SLOT_BITS(SLOT_BITS)
      ) stays (
          .clk_i,
          .write_i(push[`CTU_STACK_TO_SCHEDULER]),
          .write_slot_i(stack_slot),
          .write_data_i({stay_end_written, stay_begin_written}),
          .read_slot_i(leaf_reader_slot[0+:SLOT_BITS]),
          .read_data_o({stay_end, stay_begin})
      );
    end else begin : g_no_stays
      wire unused_stays = &{1'b0, t1_written, stay_begin_written, stay_end_written};
      assign stack_t1 = '0;
      assign stay_begin = '0;
      assign stay_end = '0;
    end
  endgenerate
  traversal_stack #(
      .SLOT_BITS(SLOT_BITS),
      .MAX_ENTRIES(STACK_ENTRIES),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(LINE_BYTES),
      .HAS_SPILLS(HAS_SPILLS),
      .EXITS(PRIMITIVE_BOXES),
      .PACKETS(PACKETS),
      .PACKET_ENTRIES(PACKET_ENTRIES)
  ) traversal_stack_stage (
      .clk_i,
      .rst_i,
      .entries_i(stack_entries_i),
      .push_width_i,
      .spill_batch_i,
      .spill_base_i,
      .spill_region_i,
      .sorted_valid_i(valid[`CTU_SORT_TO_STACK]),
      .sorted_data_i(sort_to_stack_out),
      .sorted_pop_o(pop[`CTU_SORT_TO_STACK]),
      .leaf_done_valid_i(valid[`CTU_HIT_TO_STACK]),
      .leaf_done_data_i(hit_to_stack_out),
      .leaf_done_pop_o(pop[`CTU_HIT_TO_STACK]),
      .refills_valid_i(refills_valid),
      .refills_data_i(refills),
      .refills_pop_o(refills_pop),
      .to_scheduler_ready_i(ready[`CTU_STACK_TO_SCHEDULER]),
      .to_scheduler_push_o(push[`CTU_STACK_TO_SCHEDULER]),
      .to_scheduler_data_o(stack_to_scheduler_in),
      .to_result_ready_i(ready[`CTU_STACK_TO_RESULT]),
      .to_result_push_o(push[`CTU_STACK_TO_RESULT]),
      .to_result_data_o(stack_to_result_in),
      .spills_ready_i(spills_ready),
      .spills_push_o(spills_push),
      .spills_data_o(spills),
      .starts_valid_i(starts_valid),
      .starts_data_i(starts),
      .starts_pop_o(starts_pop),
      .released_ready_i(released_ready),
      .released_push_o(released_push),
      .released_data_o(released),
      .packet_count_i(packet_count),
      .packet_o(stack_packet),
      .packet_entries_i(packet_entries),
      .slot_o(stack_slot),
      .children_i(node_children[128+:128]),
      .t0_i(stack_t0),
      .t1_i(stack_t1),
      .best_t_i(stack_best[96+:32]),
      .visit_valid_o(),
      .visit_slot_o(),
      .stay_begin_o(stay_begin_written),
      .stay_end_o(stay_end_written),
      .activity_o(activity_o[4*`CTU_TRAVERSAL_STACK+:4])
  );

  // Readers of a leaf, first one lowest: triangle_test; primitive_cull, of CULL_UNITS boxes; sphere_test.
  localparam int CULL_PORTS = PRIMITIVE_BOXES ? CULL_UNITS : 0;
  localparam int LEAF_READS = 1 + CULL_PORTS + 32'(SPHERES);
  localparam int PRIMITIVE_WORDS = PRIMITIVE_BOXES ? 16 : 10;
  localparam int PRIMITIVE = 32 * PRIMITIVE_WORDS;
  logic [LEAF_READS*SLOT_BITS-1:0] leaf_slot;
  logic [LEAF_READS*4-1:0] leaf_index;
  logic [LEAF_READS*PRIMITIVE-1:0] leaf_read;
  logic fetched_leaf_ready, fetched_leaf_push;
  logic [REF-1:0] fetched_leaf;
  leaf_fetch #(
      .SLOT_BITS(SLOT_BITS),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(LINE_BYTES),
      .PORTS(LEAF_PORTS),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS),
      .MAX_MSHRS(MAX_MSHRS),
      .MAX_HIT_LATENCY(MAX_HIT_LATENCY),
      .MAX_LEAF_BYTES(MAX_LEAF_BYTES),
      .READ_PORTS(LEAF_READS),
      .READ_WORDS(PRIMITIVE_WORDS)
  ) leaf_fetch_stage (
      .clk_i,
      .rst_i,
      .set_mask_i(leaf_set_mask_i),
      .ways_i(leaf_ways_i),
      .mshrs_i(leaf_mshrs_i),
      .hit_latency_i(leaf_hit_latency_i),
      .triangle_base_i,
      .triangle_stride_i,
      .requests_valid_i(valid[`CTU_SCHEDULER_TO_LEAF]),
      .requests_data_i(scheduler_to_leaf_out),
      .requests_pop_o(pop[`CTU_SCHEDULER_TO_LEAF]),
      .fills_valid_i(valid[`CTU_MEMORY_TO_LEAF]),
      .fills_data_i(memory_to_leaf_out),
      .fills_pop_o(pop[`CTU_MEMORY_TO_LEAF]),
      .misses_ready_i(ready[`CTU_LEAF_TO_MEMORY]),
      .misses_push_o(push[`CTU_LEAF_TO_MEMORY]),
      .misses_data_o(leaf_to_memory_in),
      .done_ready_i(fetched_leaf_ready),
      .done_push_o(fetched_leaf_push),
      .done_data_o(fetched_leaf),
      .activity_o(activity_o[4*`CTU_LEAF_FETCH+:4]),
      .triangle_slot_i(leaf_slot),
      .triangle_index_i(leaf_index),
      .triangle_o(leaf_read)
  );

  // What the leaf readers know of rays.
  localparam int LEAF_DIRECTIONS = 96 * LEAF_FILES;
  logic [LEAF_DIRECTIONS-1:0] leaf_direction;
  generate
    if (LEAF_READERS > 0) begin : g_leaf_readers
      context_file #(
          .WIDTH(96),
          .SLOT_BITS(SLOT_BITS),
          .READS(LEAF_READERS)
      ) directions (
          .clk_i,
          .write_i(ray_take_o),
          .write_slot_i(ray_slot_o),
          .write_data_i(ray_direction_i),
          .read_slot_i(leaf_reader_slot),
          .read_data_o(leaf_direction)
      );
    end else begin : g_no_leaf_readers
      assign leaf_reader_slot = '0;
      assign leaf_direction = '0;
      wire unused_leaf = &{1'b0, leaf_ray, leaf_best, leaf_direction};
    end
  endgenerate

  // From the leaf's bytes to the primitives to test.
  logic leaf_valid, leaf_pop, missed_valid, missed_pop;
  logic [REF-1:0] leaf;
  logic [15:0] leaf_met;
  logic [SLOT_BITS-1:0] missed;
  generate
    if (PRIMITIVE_BOXES) begin : g_primitive_cull
      `CTU_LINK(leaf_to_cull, `CTU_LEAF_TO_CULL, REF)
      `CTU_LINK(cull_to_triangle, `CTU_CULL_TO_TRIANGLE, REF + 16)
      `CTU_LINK(cull_to_hit, `CTU_CULL_TO_HIT, SLOT_BITS)
      `CTU_NO_LINK(`CTU_LEAF_TO_TRIANGLE)
      assign fetched_leaf_ready = ready[`CTU_LEAF_TO_CULL];
      assign push[`CTU_LEAF_TO_CULL] = fetched_leaf_push;
      assign leaf_to_cull_in = fetched_leaf;
      assign leaf_valid = valid[`CTU_CULL_TO_TRIANGLE];
      assign leaf = {cull_to_triangle_out[48+:SLOT_BITS], cull_to_triangle_out[31:0]};
      assign leaf_met = cull_to_triangle_out[47:32];
      assign pop[`CTU_CULL_TO_TRIANGLE] = leaf_pop;
      assign missed_valid = valid[`CTU_CULL_TO_HIT];
      assign missed = cull_to_hit_out;
      assign pop[`CTU_CULL_TO_HIT] = missed_pop;

      logic [SLOT_BITS-1:0] cull_slot;
      logic [192*CULL_UNITS-1:0] boxes;
      assign leaf_reader_slot[0+:SLOT_BITS] = cull_slot;
      assign leaf_slot[SLOT_BITS+:CULL_UNITS*SLOT_BITS] = {CULL_UNITS{cull_slot}};
      for (genvar u = 0; u < CULL_UNITS; u++) begin : g_box
        assign boxes[192*u+:192] = leaf_read[PRIMITIVE*(1+u)+320+:192];
      end
      primitive_cull #(
          .SLOT_BITS(SLOT_BITS),
          .UNITS(CULL_UNITS),
          .LATENCY(CULL_LATENCY)
      ) primitive_cull_stage (
          .clk_i,
          .rst_i,
          .leaf_valid_i(valid[`CTU_LEAF_TO_CULL]),
          .leaf_data_i(leaf_to_cull_out),
          .leaf_pop_o(pop[`CTU_LEAF_TO_CULL]),
          .passed_ready_i(ready[`CTU_CULL_TO_TRIANGLE]),
          .passed_push_o(push[`CTU_CULL_TO_TRIANGLE]),
          .passed_data_o(cull_to_triangle_in),
          .missed_ready_i(ready[`CTU_CULL_TO_HIT]),
          .missed_push_o(push[`CTU_CULL_TO_HIT]),
          .missed_data_o(cull_to_hit_in),
          .slot_o(cull_slot),
          .ray_origin_i(leaf_ray[ORIGIN+:96]),
          .ray_direction_i(leaf_direction[95:0]),
          .stay_begin_i(stay_begin),
          .stay_end_i(stay_end),
          .best_t_i(leaf_best[96+:32]),
          .index_o(leaf_index[4+:4*CULL_UNITS]),
          .box_i(boxes),
          .activity_o(activity_o[4*`CTU_PRIMITIVE_CULL+:4])
      );
    end else begin : g_all_primitives
      `CTU_LINK(leaf_to_triangle, `CTU_LEAF_TO_TRIANGLE, REF)
      `CTU_NO_LINK(`CTU_LEAF_TO_CULL)
      `CTU_NO_LINK(`CTU_CULL_TO_TRIANGLE)
      `CTU_NO_LINK(`CTU_CULL_TO_HIT)
      assign fetched_leaf_ready = ready[`CTU_LEAF_TO_TRIANGLE];
      assign push[`CTU_LEAF_TO_TRIANGLE] = fetched_leaf_push;
      assign leaf_to_triangle_in = fetched_leaf;
      assign leaf_valid = valid[`CTU_LEAF_TO_TRIANGLE];
      assign leaf = leaf_to_triangle_out;
      assign leaf_met = 16'hffff;
      assign pop[`CTU_LEAF_TO_TRIANGLE] = leaf_pop;
      assign missed_valid = 1'b0;
      assign missed = '0;
      wire unused_stay = &{1'b0, stay_begin, stay_end, missed_pop};
      assign activity_o[4*`CTU_PRIMITIVE_CULL+:4] = `CTU_IDLE;
    end
  endgenerate

  logic tested_primitive_ready, tested_primitive_push, outcome_valid, outcome_pop;
  logic [TESTED-1:0] tested_primitive, outcome;
  triangle_test #(
      .SLOT_BITS(SLOT_BITS),
      .LATENCY(TRIANGLE_LATENCY),
      .CULLED(PRIMITIVE_BOXES),
      .SPHERES(SPHERES)
  ) triangle_test_stage (
      .clk_i,
      .rst_i,
      .interval_i(triangle_interval_i),
      .leaf_valid_i(leaf_valid),
      .leaf_data_i(leaf),
      .leaf_met_i(leaf_met),
      .leaf_pop_o(leaf_pop),
      .tested_ready_i(tested_primitive_ready),
      .tested_push_o(tested_primitive_push),
      .tested_data_o(tested_primitive),
      .best_slot_o(triangle_best_slot),
      .best_t_i(triangle_best[96+:32]),
      .ray_slot_o(triangle_ray_slot),
      .ray_origin_i(triangle_ray[ORIGIN+:96]),
      .ray_direction_z_i(triangle_ray[DIRECTION_Z+:32]),
      .ray_kx_i(triangle_ray[KX+:2]),
      .ray_ky_i(triangle_ray[KY+:2]),
      .ray_kz_i(triangle_ray[KZ+:2]),
      .ray_sx_i(triangle_setup[SX+:32]),
      .ray_sy_i(triangle_setup[SY+:32]),
      .ray_tmin_i(triangle_ray[TMIN+:32]),
      .triangle_slot_o(leaf_slot[0+:SLOT_BITS]),
      .triangle_index_o(leaf_index[3:0]),
      .triangle_i(leaf_read[319:0]),
      .activity_o(activity_o[4*`CTU_TRIANGLE_TEST+:4])
  );
  generate
    if (SPHERES) begin : g_sphere_test
      `CTU_LINK(triangle_to_sphere, `CTU_TRIANGLE_TO_SPHERE, TESTED)
      `CTU_LINK(sphere_to_hit, `CTU_SPHERE_TO_HIT, TESTED)
      `CTU_NO_LINK(`CTU_TRIANGLE_TO_HIT)
      assign tested_primitive_ready = ready[`CTU_TRIANGLE_TO_SPHERE];
      assign push[`CTU_TRIANGLE_TO_SPHERE] = tested_primitive_push;
      assign triangle_to_sphere_in = tested_primitive;
      assign outcome_valid = valid[`CTU_SPHERE_TO_HIT];
      assign outcome = sphere_to_hit_out;
      assign pop[`CTU_SPHERE_TO_HIT] = outcome_pop;

      logic [SLOT_BITS-1:0] sphere_slot;
      assign leaf_reader_slot[SLOT_BITS*SPHERE_READER+:SLOT_BITS] = sphere_slot;
      assign leaf_slot[SLOT_BITS*(LEAF_READS-1)+:SLOT_BITS] = sphere_slot;
      sphere_test #(
          .SLOT_BITS(SLOT_BITS),
          .LATENCY(SPHERE_LATENCY)
      ) sphere_test_stage (
          .clk_i,
          .rst_i,
          .tested_valid_i(valid[`CTU_TRIANGLE_TO_SPHERE]),
          .tested_data_i(triangle_to_sphere_out),
          .tested_pop_o(pop[`CTU_TRIANGLE_TO_SPHERE]),
          .outcome_ready_i(ready[`CTU_SPHERE_TO_HIT]),
          .outcome_push_o(push[`CTU_SPHERE_TO_HIT]),
          .outcome_data_o(sphere_to_hit_in),
          .slot_o(sphere_slot),
          .index_o(leaf_index[4*(LEAF_READS-1)+:4]),
          .ray_origin_i(leaf_ray[RAY*SPHERE_READER+ORIGIN+:96]),
          .ray_direction_i(leaf_direction[96*SPHERE_READER+:96]),
          .ray_tmin_i(leaf_ray[RAY*SPHERE_READER+TMIN+:32]),
          .best_t_i(leaf_best[128*SPHERE_READER+96+:32]),
          .centre_i(leaf_read[PRIMITIVE*(LEAF_READS-1)+:96]),
          .radius_i(leaf_read[PRIMITIVE*(LEAF_READS-1)+96+:32]),
          .activity_o(activity_o[4*`CTU_SPHERE_TEST+:4])
      );
    end else begin : g_triangles_only
      `CTU_LINK(triangle_to_hit, `CTU_TRIANGLE_TO_HIT, TESTED)
      `CTU_NO_LINK(`CTU_TRIANGLE_TO_SPHERE)
      `CTU_NO_LINK(`CTU_SPHERE_TO_HIT)
      assign tested_primitive_ready = ready[`CTU_TRIANGLE_TO_HIT];
      assign push[`CTU_TRIANGLE_TO_HIT] = tested_primitive_push;
      assign triangle_to_hit_in = tested_primitive;
      assign outcome_valid = valid[`CTU_TRIANGLE_TO_HIT];
      assign outcome = triangle_to_hit_out;
      assign pop[`CTU_TRIANGLE_TO_HIT] = outcome_pop;
      assign activity_o[4*`CTU_SPHERE_TEST+:4] = `CTU_IDLE;
    end
  endgenerate

  hit_update #(
      .SLOT_BITS(SLOT_BITS),
      .LATENCY(HIT_LATENCY),
      .HAS_MISSED(PRIMITIVE_BOXES)
  ) hit_update_stage (
      .clk_i,
      .rst_i,
      .tested_valid_i(outcome_valid),
      .tested_data_i(outcome),
      .tested_pop_o(outcome_pop),
      .missed_valid_i(missed_valid),
      .missed_data_i(missed),
      .missed_pop_o(missed_pop),
      .done_ready_i(ready[`CTU_HIT_TO_STACK]),
      .done_push_o(push[`CTU_HIT_TO_STACK]),
      .done_data_o(hit_to_stack_in),
      .best_slot_o(hit_slot),
      .best_t_i(hit_best[96+:32]),
      .best_primitive_i(hit_best[31:0]),
      .best_any_hit_i(hit_ray[ANY_HIT]),
      .best_write_o(best_write),
      .best_t_o(best_written[96+:32]),
      .best_u_o(best_written[64+:32]),
      .best_v_o(best_written[32+:32]),
      .best_primitive_o(best_written[31:0]),
      .activity_o(activity_o[4*`CTU_HIT_UPDATE+:4])
  );

  result_queue #(
      .SLOT_BITS(SLOT_BITS)
  ) result_queue_stage (
      .clk_i,
      .rst_i,
      .interval_i(result_interval_i),
      .from_stack_valid_i(valid[`CTU_STACK_TO_RESULT]),
      .from_stack_data_i(stack_to_result_out),
      .from_stack_pop_o(pop[`CTU_STACK_TO_RESULT]),
      .from_rays_valid_i(valid[`CTU_RAY_TO_RESULT]),
      .from_rays_data_i(ray_to_result_out),
      .from_rays_pop_o(pop[`CTU_RAY_TO_RESULT]),
      .freed_ready_i(ready[`CTU_RESULT_TO_RAY]),
      .freed_push_o(push[`CTU_RESULT_TO_RAY]),
      .freed_data_o(result_to_ray_in),
      .return_valid_o,
      .return_slot_o,
      .activity_o(activity_o[4*`CTU_RESULT_QUEUE+:4])
  );

  // Clients of memory: node_fetch, leaf_fetch, and where there is one the stack, whose requests alone carry a line, and
  // table_fetch, which is the fourth whether or not there is a third.
  logic [CLIENTS-1:0] requests_valid, requests_pop, answers_ready, answers_push;
  logic [CLIENTS*REQUEST-1:0] requests;
  logic [RESPONSE-1:0] answer;
  logic [LINE-1:0] written_line;
  assign requests_valid[1:0] = {valid[`CTU_LEAF_TO_MEMORY], valid[`CTU_NODE_TO_MEMORY]};
  assign requests[0+:2*REQUEST] = {leaf_to_memory_out, node_to_memory_out};
  assign {pop[`CTU_LEAF_TO_MEMORY], pop[`CTU_NODE_TO_MEMORY]} = requests_pop[1:0];
  assign answers_ready[1:0] = {ready[`CTU_MEMORY_TO_LEAF], ready[`CTU_MEMORY_TO_NODE]};
  assign {push[`CTU_MEMORY_TO_LEAF], push[`CTU_MEMORY_TO_NODE]} = answers_push[1:0];
  assign memory_to_node_in = answer;
  assign memory_to_leaf_in = answer;
  generate
    if (HAS_SPILLS) begin : g_stack_client
      assign requests_valid[2] = valid[`CTU_STACK_TO_MEMORY];
      assign requests[2*REQUEST+:REQUEST] = g_spills.stack_to_memory_out[LINE+:REQUEST];
      assign pop[`CTU_STACK_TO_MEMORY] = requests_pop[2];
      assign answers_ready[2] = ready[`CTU_MEMORY_TO_STACK];
      assign push[`CTU_MEMORY_TO_STACK] = answers_push[2];
      assign g_spills.memory_to_stack_in = answer;
      assign written_line = g_spills.stack_to_memory_out[LINE-1:0];
    end else begin : g_no_stack_client
      assign written_line = '0;
      if (CLIENTS > 2) begin : g_gap
        assign requests_valid[2] = 1'b0;
        assign requests[2*REQUEST+:REQUEST] = '0;
        assign answers_ready[2] = 1'b0;
      end
    end
    if (TABLE_CACHE) begin : g_table_client
      assign requests_valid[3] = valid[`CTU_TABLE_TO_MEMORY];
      assign requests[3*REQUEST+:REQUEST] = g_culling.g_tables.table_to_memory_out;
      assign pop[`CTU_TABLE_TO_MEMORY] = requests_pop[3];
      assign answers_ready[3] = ready[`CTU_MEMORY_TO_TABLE];
      assign push[`CTU_MEMORY_TO_TABLE] = answers_push[3];
      assign g_culling.g_tables.memory_to_table_in = answer;
    end else begin : g_no_table_client
      `CTU_NO_LINK(`CTU_LOCATE_TO_TABLE)
      `CTU_NO_LINK(`CTU_TABLE_TO_MASK)
      `CTU_NO_LINK(`CTU_TABLE_TO_MEMORY)
      `CTU_NO_LINK(`CTU_MEMORY_TO_TABLE)
      assign activity_o[4*`CTU_TABLE_FETCH+:4] = `CTU_IDLE;
    end
  endgenerate
  assign mem_asked_o = requests_valid;
  memory_port #(
      .CLIENTS(CLIENTS),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(LINE_BYTES)
  ) memory_port_stage (
      .clk_i,
      .rst_i,
      .requests_valid_i(requests_valid),
      .requests_data_i(requests),
      .write_data_i(written_line),
      .requests_pop_o(requests_pop),
      .answers_ready_i(answers_ready),
      .answers_push_o(answers_push),
      .answers_data_o(answer),
      .activity_o(activity_o[4*`CTU_MEMORY_PORT+:4]),
      .mem_address_o,
      .mem_accepts_i(mem_can_accept_i),
      .mem_request_o(mem_request_valid_o),
      .mem_request_client_o,
      .mem_request_data_o({mem_request_address_o, mem_request_id_o, mem_request_write_o}),
      .mem_write_data_o(mem_request_data_o),
      .mem_answer_valid_i,
      .mem_answer_client_i,
      .mem_answer_data_i({mem_answer_id_i, mem_answer_data_i}),
      .mem_answer_take_o,
      .mem_busy_i
  );
endmodule
