// unit_bench: ctu_unit with ports of the same widths whatever its parameters are, so that one harness (verilated_unit.h)
// drives every build; and with all links and accounts laid open.
`include "links.svh"
`include "mask_designs.svh"
`include "tokens.svh"

module unit_bench #(
    parameter int DESIGN = 5,
    parameter int R = 4,
    parameter int R_RAY = 4,
    parameter int ENTRIES = 0,
    parameter int ROWS = 0,
    parameter int BANKS = 4,
    parameter int PORTS = 1,
    parameter int PROJECTION_TABLES = 3,
    parameter int UNITS = 1,
    parameter int TABLE_CACHE = 0,
    parameter int NODE_PORTS = 1,
    parameter int LEAF_PORTS = 1,
    parameter int TABLE_PORTS = 1,
    parameter int LINE_BYTES = 128,
    parameter int SLOT_BITS = 6,
    parameter int BOX_BITS = 32,
    parameter int PRIMITIVE_BOXES = 0,
    parameter int SPHERES = 0,
    parameter int CULL_UNITS = 1,
    parameter int PACKETS = 0,
    parameter int PACKET_ENTRIES = 16,
    parameter int MIN_PACKET_INTERVAL = 4,
    parameter int TREES = 1,
    parameter int MAX_LEAF_BYTES = 160,
    parameter int STACK_ENTRIES = 64,
    parameter int HAS_SPILLS = 1,
    parameter int MAX_SETS = 256,
    parameter int MAX_WAYS = 8,
    parameter int MAX_MSHRS = 16,
    parameter int RAY_SETUP_LATENCY = 20,
    parameter int MIN_RAY_INTERVAL = 3,
    parameter int DECODE_LATENCY = 5,
    parameter int BOX_LATENCY = 11,
    parameter int LOCATE_LATENCY = 10,
    parameter int MASK_LATENCY = 2,
    parameter int MASK_SECOND_LATENCY = 1,
    parameter int SORT_LATENCY = 3,
    parameter int CULL_LATENCY = 10,
    parameter int PACKET_LATENCY = 12,
    parameter int TRIANGLE_LATENCY = 45,
    parameter int SPHERE_LATENCY = 89,
    parameter int HIT_LATENCY = 2,
    parameter int DISTINCT = 1270
) (
    input logic clk_i,
    input logic rst_i,

    input logic [15:0] contexts_i,
    input logic [ 7:0] ray_interval_i,
    input logic [ 7:0] packets_i,
    input logic [ 7:0] packet_entries_i,
    input logic [ 7:0] packet_interval_i,
    input logic        round_robin_i,
    // Caches of nodes, leaves, tables.
    input logic [15:0] cache_sets_i        [3],  // in use, a power of two; 0: no cache
    input logic [ 7:0] cache_ways_i        [3],
    input logic [ 7:0] cache_mshrs_i       [3],
    input logic [ 7:0] cache_hit_latency_i [3],
    input logic [63:0] table_base_i        [4],
    input logic [ 7:0] bit_row_shift_i,          // log2 of a bit row's bytes in memory
    input logic [63:0] node_base_i,
    input logic [15:0] node_stride_i,
    input logic [31:0] masked_nodes_i,
    input logic [63:0] bare_base_i,
    input logic [15:0] bare_stride_i,
    input logic [15:0] full_index_i,
    input logic [63:0] triangle_base_i,
    input logic [15:0] triangle_stride_i,
    input logic [ 7:0] triangle_interval_i,
    input logic [15:0] result_interval_i,
    input logic [ 7:0] stack_entries_i,
    input logic [ 7:0] push_width_i,
    input logic [ 7:0] spill_batch_i,
    input logic [63:0] spill_base_i,
    input logic [31:0] spill_region_i,

    input  logic        ray_valid_i,
    input  logic [95:0] ray_origin_i,
    input  logic [95:0] ray_direction_i,
    input  logic [31:0] ray_tmin_i,
    input  logic [31:0] ray_tmax_i,
    input  logic        ray_any_hit_i,
    input  logic        ray_closes_i,
    input  logic [ 7:0] ray_tree_i,
    output logic        ray_take_o,
    output logic [ 7:0] ray_slot_o,

    output logic         return_valid_o,
    output logic [  7:0] return_slot_o,
    output logic [127:0] return_hit_o,

    input  logic [             3:0] mem_can_accept_i,
    output logic [             3:0] mem_asked_o,
    output logic [            63:0] mem_address_o        [4],
    output logic                    mem_request_valid_o,
    output logic [             7:0] mem_request_client_o,
    output logic [            63:0] mem_request_address_o,
    output logic [             7:0] mem_request_id_o,
    output logic                    mem_request_write_o,
    output logic [8*LINE_BYTES-1:0] mem_request_data_o,
    input  logic                    mem_answer_valid_i,
    input  logic [             7:0] mem_answer_client_i,
    input  logic [             7:0] mem_answer_id_i,
    input  logic [8*LINE_BYTES-1:0] mem_answer_data_i,
    output logic                    mem_answer_take_o,
    input  logic                    mem_busy_i,

    input logic         load_valid_i,
    input logic [  7:0] load_table_i,
    input logic [ 31:0] load_row_i,
    input logic [511:0] load_data_i,
    input logic         root_write_i,
    input logic [  7:0] root_tree_i,
    input logic [ 31:0] root_i,

    output logic         row_left_out_o,
    output logic [  7:0] row_left_out_slot_o,

    input  logic [ 63:0] stall_push_i,
    input  logic [ 63:0] stall_pop_i,
    output logic [ 63:0] link_valid_o,
    output logic [ 63:0] link_ready_o,
    output logic [ 63:0] link_pop_o,
    output logic [ 63:0] link_push_o,
    output logic [159:0] link_data_o [`CTU_LINKS],  // what is pushed; of memory's tokens without the line
    output logic [  7:0] activity_o  [`CTU_STAGES]
);
  localparam int ADDRESS_BITS = 40;
  localparam int LOAD_BITS = `CTU_LOAD_BITS(DESIGN, R, ENTRIES);
  localparam int SET_BITS = MAX_SETS == 1 ? 1 : $clog2(MAX_SETS);
  localparam int WAY_BITS = $clog2(MAX_WAYS + 1);
  localparam int MSHR_BITS = $clog2(MAX_MSHRS + 1);
  localparam int CLIENTS = TABLE_CACHE != 0 ? 4 : HAS_SPILLS != 0 ? 3 : 2;
  localparam int PACKET_BITS = PACKETS <= 2 ? 1 : $clog2(PACKETS);
  localparam int TREE_BITS = TREES <= 2 ? 1 : $clog2(TREES);

  logic [CLIENTS-1:0] asked;
  logic [CLIENTS*ADDRESS_BITS-1:0] address;
  logic [4*`CTU_STAGES-1:0] activity;

  ctu_unit #(
      .SLOT_BITS(SLOT_BITS),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(LINE_BYTES),
      .DESIGN(DESIGN),
      .R(R),
      .R_RAY(R_RAY),
      .ENTRIES(ENTRIES),
      .ROWS(ROWS),
      .DISTINCT(DISTINCT),
      .PROJECTION_TABLES(PROJECTION_TABLES),
      .BANKS(BANKS),
      .PORTS(PORTS),
      .UNITS(UNITS),
      .NODE_PORTS(NODE_PORTS),
      .LEAF_PORTS(LEAF_PORTS),
      .TABLE_CACHE(TABLE_CACHE != 0),
      .TABLE_PORTS(TABLE_PORTS),
      .BOX_BITS(BOX_BITS),
      .PRIMITIVE_BOXES(PRIMITIVE_BOXES != 0),
      .SPHERES(SPHERES != 0),
      .CULL_UNITS(CULL_UNITS),
      .PACKETS(PACKETS),
      .PACKET_ENTRIES(PACKET_ENTRIES),
      .MIN_PACKET_INTERVAL(MIN_PACKET_INTERVAL),
      .TREES(TREES),
      .STACK_ENTRIES(STACK_ENTRIES),
      .HAS_SPILLS(HAS_SPILLS != 0),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS),
      .MAX_MSHRS(MAX_MSHRS),
      .MAX_HIT_LATENCY(31),
      .MAX_LEAF_BYTES(MAX_LEAF_BYTES),
      .RAY_SETUP_LATENCY(RAY_SETUP_LATENCY),
      .MIN_RAY_INTERVAL(MIN_RAY_INTERVAL),
      .DECODE_LATENCY(DECODE_LATENCY),
      .BOX_LATENCY(BOX_LATENCY),
      .LOCATE_LATENCY(LOCATE_LATENCY),
      .MASK_LATENCY(MASK_LATENCY),
      .MASK_SECOND_LATENCY(MASK_SECOND_LATENCY),
      .SORT_LATENCY(SORT_LATENCY),
      .CULL_LATENCY(CULL_LATENCY),
      .PACKET_LATENCY(PACKET_LATENCY),
      .TRIANGLE_LATENCY(TRIANGLE_LATENCY),
      .SPHERE_LATENCY(SPHERE_LATENCY),
      .HIT_LATENCY(HIT_LATENCY),
      .LOAD_BITS(LOAD_BITS)
  ) unit (
      .clk_i,
      .rst_i,
      .contexts_i((SLOT_BITS + 1)'(contexts_i)),
      .ray_interval_i(7'(ray_interval_i)),
      .packets_i((PACKET_BITS + 1)'(packets_i)),
      .packet_entries_i(5'(packet_entries_i)),
      .packet_interval_i(7'(packet_interval_i)),
      .round_robin_i,
      .node_set_mask_i(SET_BITS'(cache_sets_i[0] - 16'd1)),
      .node_ways_i(WAY_BITS'(cache_ways_i[0])),
      .node_mshrs_i(MSHR_BITS'(cache_mshrs_i[0])),
      .node_hit_latency_i(5'(cache_hit_latency_i[0])),
      .leaf_set_mask_i(SET_BITS'(cache_sets_i[1] - 16'd1)),
      .leaf_ways_i(WAY_BITS'(cache_ways_i[1])),
      .leaf_mshrs_i(MSHR_BITS'(cache_mshrs_i[1])),
      .leaf_hit_latency_i(5'(cache_hit_latency_i[1])),
      .table_set_mask_i(SET_BITS'(cache_sets_i[2] - 16'd1)),
      .table_ways_i(WAY_BITS'(cache_ways_i[2])),
      .table_mshrs_i(MSHR_BITS'(cache_mshrs_i[2])),
      .table_hit_latency_i(5'(cache_hit_latency_i[2])),
      .table_base_i({ADDRESS_BITS'(table_base_i[3]), ADDRESS_BITS'(table_base_i[2]), ADDRESS_BITS'(table_base_i[1]),
                     ADDRESS_BITS'(table_base_i[0])}),
      .bit_row_shift_i(4'(bit_row_shift_i)),
      .node_base_i(ADDRESS_BITS'(node_base_i)),
      .node_stride_i(13'(node_stride_i)),
      .masked_nodes_i(31'(masked_nodes_i)),
      .bare_base_i(ADDRESS_BITS'(bare_base_i)),
      .bare_stride_i(13'(bare_stride_i)),
      .full_index_i(12'(full_index_i)),
      .triangle_base_i(ADDRESS_BITS'(triangle_base_i)),
      .triangle_stride_i(13'(triangle_stride_i)),
      .triangle_interval_i(7'(triangle_interval_i)),
      .result_interval_i(10'(result_interval_i)),
      .stack_entries_i(7'(stack_entries_i)),
      .push_width_i(2'(push_width_i)),
      .spill_batch_i(7'(spill_batch_i)),
      .spill_base_i(ADDRESS_BITS'(spill_base_i)),
      .spill_region_i(ADDRESS_BITS'(spill_region_i)),
      .ray_valid_i,
      .ray_origin_i,
      .ray_direction_i,
      .ray_tmin_i,
      .ray_tmax_i,
      .ray_any_hit_i,
      .ray_closes_i,
      .ray_tree_i(ray_tree_i[TREE_BITS-1:0]),
      .ray_take_o,
      .ray_slot_o(ray_slot_o[SLOT_BITS-1:0]),
      .return_valid_o,
      .return_slot_o(return_slot_o[SLOT_BITS-1:0]),
      .return_hit_o,
      .mem_can_accept_i(mem_can_accept_i[CLIENTS-1:0]),
      .mem_asked_o(asked),
      .mem_address_o(address),
      .mem_request_valid_o,
      .mem_request_client_o(mem_request_client_o[1:0]),
      .mem_request_address_o(mem_request_address_o[ADDRESS_BITS-1:0]),
      .mem_request_id_o,
      .mem_request_write_o,
      .mem_request_data_o,
      .mem_answer_valid_i,
      .mem_answer_client_i(mem_answer_client_i[1:0]),
      .mem_answer_id_i,
      .mem_answer_data_i,
      .mem_answer_take_o,
      .mem_busy_i,
      .load_valid_i,
      .load_table_i(load_table_i[1:0]),
      .load_row_i(load_row_i[27:0]),
      .load_data_i(load_data_i[LOAD_BITS-1:0]),
      .root_write_i,
      .root_tree_i(root_tree_i[TREE_BITS-1:0]),
      .root_i,
      .row_left_out_o,
      .row_left_out_slot_o(row_left_out_slot_o[SLOT_BITS-1:0]),
      .activity_o(activity),
      .stall_push_i(stall_push_i[`CTU_LINKS-1:0]),
      .stall_pop_i(stall_pop_i[`CTU_LINKS-1:0])
  );

  assign ray_slot_o[7:SLOT_BITS] = '0;
  assign return_slot_o[7:SLOT_BITS] = '0;
  assign row_left_out_slot_o[7:SLOT_BITS] = '0;
  assign mem_asked_o = 4'(asked);
  assign mem_request_client_o[7:2] = '0;
  assign mem_request_address_o[63:ADDRESS_BITS] = '0;
  generate
    for (genvar c = 0; c < 4; c++) begin : g_address
      if (c < CLIENTS) begin : g_there
        assign mem_address_o[c] = 64'(address[ADDRESS_BITS*c+:ADDRESS_BITS]);
      end else begin : g_none
        assign mem_address_o[c] = '0;
      end
    end
    for (genvar stage = 0; stage < `CTU_STAGES; stage++) begin : g_activity
      assign activity_o[stage] = 8'(activity[4*stage+:4]);
    end
  endgenerate

  assign link_valid_o = 64'(unit.valid);
  assign link_ready_o = 64'(unit.ready);
  assign link_pop_o = 64'(unit.pop);
  assign link_push_o = 64'(unit.push);
  assign link_data_o[`CTU_RAY_TO_RESULT] = 160'(unit.ray_to_result_in);
  assign link_data_o[`CTU_RESULT_TO_RAY] = 160'(unit.result_to_ray_in);
  assign link_data_o[`CTU_SCHEDULER_TO_NODE] = 160'(unit.scheduler_to_node_in);
  assign link_data_o[`CTU_SCHEDULER_TO_LEAF] = 160'(unit.scheduler_to_leaf_in);
  assign link_data_o[`CTU_NODE_TO_BOX] = 160'(unit.node_to_box_in);
  assign link_data_o[`CTU_SORT_TO_STACK] = 160'(unit.sort_to_stack_in);
  assign link_data_o[`CTU_HIT_TO_STACK] = 160'(unit.hit_to_stack_in);
  assign link_data_o[`CTU_STACK_TO_SCHEDULER] = 160'(unit.stack_to_scheduler_in);
  assign link_data_o[`CTU_STACK_TO_RESULT] = 160'(unit.stack_to_result_in);
  assign link_data_o[`CTU_NODE_TO_MEMORY] = 160'(unit.node_to_memory_in);
  assign link_data_o[`CTU_LEAF_TO_MEMORY] = 160'(unit.leaf_to_memory_in);
  assign link_data_o[`CTU_MEMORY_TO_NODE] = 160'(unit.memory_to_node_in[8*LINE_BYTES+:`CTU_ID_BITS]);
  assign link_data_o[`CTU_MEMORY_TO_LEAF] = 160'(unit.memory_to_leaf_in[8*LINE_BYTES+:`CTU_ID_BITS]);
  generate
    if (HAS_SPILLS != 0) begin : g_spills
      assign link_data_o[`CTU_STACK_TO_MEMORY] =
          160'(unit.g_spills.stack_to_memory_in[8*LINE_BYTES+:ADDRESS_BITS+`CTU_ID_BITS+1]);
      assign link_data_o[`CTU_MEMORY_TO_STACK] =
          160'(unit.g_spills.memory_to_stack_in[8*LINE_BYTES+:`CTU_ID_BITS]);
    end else begin : g_no_spills
      assign link_data_o[`CTU_STACK_TO_MEMORY] = '0;
      assign link_data_o[`CTU_MEMORY_TO_STACK] = '0;
    end
    // Of leaves that have not been culled all primitives are to be tested.
    wire [SLOT_BITS-1:0] leaf_slot = unit.fetched_leaf[32+:SLOT_BITS];
    wire [SLOT_BITS+47:0] whole_leaf = {leaf_slot, 16'hffff, unit.fetched_leaf[31:0]};
    if (PRIMITIVE_BOXES != 0) begin : g_primitive_cull
      assign link_data_o[`CTU_LEAF_TO_TRIANGLE] = '0;
      assign link_data_o[`CTU_LEAF_TO_CULL] = 160'(whole_leaf);
      assign link_data_o[`CTU_CULL_TO_TRIANGLE] = 160'(unit.g_primitive_cull.cull_to_triangle_in);
      assign link_data_o[`CTU_CULL_TO_HIT] = 160'(unit.g_primitive_cull.cull_to_hit_in);
    end else begin : g_all_primitives
      assign link_data_o[`CTU_LEAF_TO_TRIANGLE] = 160'(whole_leaf);
      assign link_data_o[`CTU_LEAF_TO_CULL] = '0;
      assign link_data_o[`CTU_CULL_TO_TRIANGLE] = '0;
      assign link_data_o[`CTU_CULL_TO_HIT] = '0;
    end
    // Numbers of packets in the model's width.
    if (PACKETS != 0) begin : g_packets
      wire [SLOT_BITS-1:0] start_slot = unit.g_packets.packet_to_stack_in[PACKET_BITS+1+:SLOT_BITS];
      wire [5:0] start_packet = 6'(unit.g_packets.packet_to_stack_in[PACKET_BITS:1]);
      assign link_data_o[`CTU_RAY_TO_SCHEDULER] = '0;
      assign link_data_o[`CTU_RAY_TO_PACKET] = 160'(unit.g_packets.ray_to_packet_in);
      assign link_data_o[`CTU_PACKET_TO_SCHEDULER] = 160'({1'b1, unit.g_packets.packet_to_scheduler_in});
      assign link_data_o[`CTU_NODE_TO_PACKET] = 160'(unit.g_packets.node_to_packet_in);
      assign link_data_o[`CTU_PACKET_TO_STACK] =
          160'({start_slot, start_packet, unit.g_packets.packet_to_stack_in[0]});
      assign link_data_o[`CTU_STACK_TO_PACKET] = 160'(unit.g_packets.stack_to_packet_in);
    end else begin : g_no_packets
      assign link_data_o[`CTU_RAY_TO_SCHEDULER] = 160'(unit.g_no_packets.ray_to_scheduler_in);
      assign link_data_o[`CTU_RAY_TO_PACKET] = '0;
      assign link_data_o[`CTU_PACKET_TO_SCHEDULER] = '0;
      assign link_data_o[`CTU_NODE_TO_PACKET] = '0;
      assign link_data_o[`CTU_PACKET_TO_STACK] = '0;
      assign link_data_o[`CTU_STACK_TO_PACKET] = '0;
    end
    if (SPHERES != 0) begin : g_sphere_test
      assign link_data_o[`CTU_TRIANGLE_TO_HIT] = '0;
      assign link_data_o[`CTU_TRIANGLE_TO_SPHERE] = 160'(unit.tested_primitive);
      assign link_data_o[`CTU_SPHERE_TO_HIT] = 160'(unit.g_sphere_test.sphere_to_hit_in);
    end else begin : g_triangles_only
      assign link_data_o[`CTU_TRIANGLE_TO_HIT] = 160'(unit.tested_primitive);
      assign link_data_o[`CTU_TRIANGLE_TO_SPHERE] = '0;
      assign link_data_o[`CTU_SPHERE_TO_HIT] = '0;
    end
    if (DESIGN != `CTU_DESIGN_NONE) begin : g_culling
      assign link_data_o[`CTU_BOX_TO_LOCATE] = 160'(unit.g_culling.box_to_locate_in);
      assign link_data_o[`CTU_LOCATE_TO_MASK] = TABLE_CACHE != 0 ? '0 : 160'(unit.g_culling.located);
      assign link_data_o[`CTU_MASK_TO_SORT] = 160'(unit.g_culling.mask_to_sort_in);
      assign link_data_o[`CTU_BOX_TO_SORT] = '0;
    end else begin : g_no_culling
      assign link_data_o[`CTU_BOX_TO_LOCATE] = '0;
      assign link_data_o[`CTU_LOCATE_TO_MASK] = '0;
      assign link_data_o[`CTU_MASK_TO_SORT] = '0;
      assign link_data_o[`CTU_BOX_TO_SORT] = 160'(unit.g_no_culling.box_to_sort_in);
    end
    if (TABLE_CACHE != 0) begin : g_tables
      assign link_data_o[`CTU_LOCATE_TO_TABLE] = 160'(unit.g_culling.g_tables.locate_to_table_in);
      assign link_data_o[`CTU_TABLE_TO_MASK] = 160'(unit.g_culling.g_tables.table_to_mask_in);
      assign link_data_o[`CTU_TABLE_TO_MEMORY] = 160'(unit.g_culling.g_tables.table_to_memory_in);
      assign link_data_o[`CTU_MEMORY_TO_TABLE] =
          160'(unit.g_culling.g_tables.memory_to_table_in[8*LINE_BYTES+:`CTU_ID_BITS]);
    end else begin : g_no_tables
      assign link_data_o[`CTU_LOCATE_TO_TABLE] = '0;
      assign link_data_o[`CTU_TABLE_TO_MASK] = '0;
      assign link_data_o[`CTU_TABLE_TO_MEMORY] = '0;
      assign link_data_o[`CTU_MEMORY_TO_TABLE] = '0;
    end
  endgenerate
endmodule
