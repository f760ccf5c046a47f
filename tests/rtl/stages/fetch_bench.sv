// node_fetch, first of the arrays, and leaf_fetch beside each other, with two readers of nodes.
module fetch_bench #(
    parameter int SLOT_BITS = 3,
    parameter int LINE_BYTES = 128,
    parameter int PORTS = 1,
    parameter int MASK_BITS = 64,
    parameter int MAX_SETS = 64,
    parameter int MAX_WAYS = 16,
    parameter int MAX_MSHRS = 8,
    parameter int MAX_HIT_LATENCY = 20,
    parameter int MAX_STRIDE = 256,
    parameter int MAX_LEAF_BYTES = 256
) (
    input logic clk_i,
    input logic rst_i,

    input logic [15:0] set_mask_i       [2],
    input logic [ 4:0] ways_i           [2],
    input logic [ 6:0] mshrs_i          [2],
    input logic [ 6:0] hit_latency_i    [2],
    input logic [31:0] node_base_i,
    input logic [12:0] node_stride_i,
    input logic [30:0] masked_nodes_i,
    input logic [31:0] bare_base_i,
    input logic [12:0] bare_stride_i,
    input logic [63:0] full_mask_i,
    input logic [31:0] triangle_base_i,
    input logic [12:0] triangle_stride_i,

    input  logic                    requests_valid_i[2],
    input  logic [  SLOT_BITS+31:0] requests_data_i [2],
    output logic                    requests_pop_o  [2],
    input  logic                    fills_valid_i   [2],
    input  logic [8*LINE_BYTES+7:0] fills_data_i    [2],
    output logic                    fills_pop_o     [2],
    input  logic                    misses_ready_i  [2],
    output logic                    misses_push_o   [2],
    output logic [            40:0] misses_data_o   [2],
    input  logic                    done_ready_i    [2],
    output logic                    done_push_o     [2],
    output logic [  SLOT_BITS+31:0] done_data_o     [2],
    output logic [             3:0] activity_o      [2],

    input  logic [SLOT_BITS-1:0] node_slot_i         [2],
    output logic [        767:0] node_boxes_o        [2],
    output logic [        127:0] node_children_o     [2],
    output logic [        255:0] node_masks_o        [2],  // 64 bits for each lane
    output logic [          3:0] node_full_o         [2],
    input  logic [SLOT_BITS-1:0] triangle_slot_i,
    input  logic [          3:0] triangle_index_i,
    output logic [        287:0] triangle_vertices_o,
    output logic [         31:0] triangle_primitive_o
);
  localparam int SET_BITS = $clog2(MAX_SETS);
  localparam int LANE_BITS = MASK_BITS == 0 ? 1 : MASK_BITS;

  logic [8*LANE_BITS-1:0] masks;
  logic no_packets;
  node_fetch #(
      .SLOT_BITS(SLOT_BITS),
      .LINE_BYTES(LINE_BYTES),
      .PORTS(PORTS),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS),
      .MAX_MSHRS(MAX_MSHRS),
      .MAX_HIT_LATENCY(MAX_HIT_LATENCY),
      .MASK_BITS(MASK_BITS),
      .MAX_STRIDE(MAX_STRIDE),
      .READ_PORTS(2)
  ) node_fetch (
      .clk_i,
      .rst_i,
      .set_mask_i(set_mask_i[0][SET_BITS-1:0]),
      .ways_i(ways_i[0][$clog2(MAX_WAYS+1)-1:0]),
      .mshrs_i(mshrs_i[0][$clog2(MAX_MSHRS+1)-1:0]),
      .hit_latency_i(hit_latency_i[0][$clog2(MAX_HIT_LATENCY+1)-1:0]),
      .node_base_i,
      .node_stride_i,
      .masked_nodes_i,
      .bare_base_i,
      .bare_stride_i,
      .full_mask_i(full_mask_i[LANE_BITS-1:0]),
      .requests_valid_i(requests_valid_i[0]),
      .requests_data_i(requests_data_i[0]),
      .requests_pop_o(requests_pop_o[0]),
      .fills_valid_i(fills_valid_i[0]),
      .fills_data_i(fills_data_i[0]),
      .fills_pop_o(fills_pop_o[0]),
      .misses_ready_i(misses_ready_i[0]),
      .misses_push_o(misses_push_o[0]),
      .misses_data_o(misses_data_o[0]),
      .done_ready_i(done_ready_i[0]),
      .done_push_o(done_push_o[0]),
      .done_data_o(done_data_o[0]),
      .packets_ready_i(1'b0),
      .packets_push_o(no_packets),
      .activity_o(activity_o[0]),
      .node_slot_i({node_slot_i[1], node_slot_i[0]}),
      .node_boxes_o({node_boxes_o[1], node_boxes_o[0]}),
      .node_children_o({node_children_o[1], node_children_o[0]}),
      .node_masks_o(masks),
      .node_full_o({node_full_o[1], node_full_o[0]})
  );
  always_comb begin
    for (int port = 0; port < 2; port++)
      for (int lane = 0; lane < 4; lane++)
        node_masks_o[port][64*lane+:64] = 64'(masks[LANE_BITS*(4*port+lane)+:LANE_BITS]);
  end

  leaf_fetch #(
      .SLOT_BITS(SLOT_BITS),
      .LINE_BYTES(LINE_BYTES),
      .PORTS(PORTS),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS),
      .MAX_MSHRS(MAX_MSHRS),
      .MAX_HIT_LATENCY(MAX_HIT_LATENCY),
      .MAX_LEAF_BYTES(MAX_LEAF_BYTES)
  ) leaf_fetch (
      .clk_i,
      .rst_i,
      .set_mask_i(set_mask_i[1][SET_BITS-1:0]),
      .ways_i(ways_i[1][$clog2(MAX_WAYS+1)-1:0]),
      .mshrs_i(mshrs_i[1][$clog2(MAX_MSHRS+1)-1:0]),
      .hit_latency_i(hit_latency_i[1][$clog2(MAX_HIT_LATENCY+1)-1:0]),
      .triangle_base_i,
      .triangle_stride_i,
      .requests_valid_i(requests_valid_i[1]),
      .requests_data_i(requests_data_i[1]),
      .requests_pop_o(requests_pop_o[1]),
      .fills_valid_i(fills_valid_i[1]),
      .fills_data_i(fills_data_i[1]),
      .fills_pop_o(fills_pop_o[1]),
      .misses_ready_i(misses_ready_i[1]),
      .misses_push_o(misses_push_o[1]),
      .misses_data_o(misses_data_o[1]),
      .done_ready_i(done_ready_i[1]),
      .done_push_o(done_push_o[1]),
      .done_data_o(done_data_o[1]),
      .activity_o(activity_o[1]),
      .triangle_slot_i,
      .triangle_index_i,
      .triangle_o({triangle_primitive_o, triangle_vertices_o})
  );
endmodule
