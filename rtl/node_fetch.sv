// node_fetch: brings the bytes of a node, [address, + stride), through node_cache, and keeps them by context.
//
//   latency and interval as line_fetch
//   twin    model/pipeline/node_fetch.h; addresses as UnitImage::node_bytes, layout of a node as model/accel/image.h, of
//           BOX_BITS below 32 as model/accel/compact_node.h
//   stated  docs/unit.md
//
// A node is put in order when it leaves: it can be read from the next cycle on, until its context's next one leaves.
// Nodes from masked_nodes on are bare: all of their masks read as full. Address and lines are found in the cycle in
// which the token is taken.
module node_fetch #(
    parameter int SLOT_BITS = 1,
    parameter int ADDRESS_BITS = 32,
    parameter int LINE_BYTES = 32,
    parameter int PORTS = 1,           // lines looked up in a cycle
    parameter int MAX_SETS = 2,        // of the cache, a power of two
    parameter int MAX_WAYS = 2,
    parameter int MAX_MSHRS = 4,
    parameter int MAX_HIT_LATENCY = 4,
    parameter int MASK_BITS = 8,       // of a lane's mask in the image, or its whole bytes; 0: no masks
    parameter int MAX_STRIDE = 116,    // bytes
    parameter int BOX_BITS = 32,       // of a coordinate in the image: 32, or 16, 12, 8
    parameter int READ_PORTS = 1,      // stages that read nodes
    parameter bit PACKETS = 1'b0,      // some nodes are packets'
    localparam int OF_PACKET = PACKETS ? 1 : 0,
    localparam int BOXES_BITS = BOX_BITS == 32 ? 768 : 128 + 24 * BOX_BITS,
    localparam int SET_BITS = MAX_SETS == 1 ? 1 : $clog2(MAX_SETS),
    localparam int LANE_BITS = MASK_BITS == 0 ? 1 : MASK_BITS
) (
    input logic clk_i,
    input logic rst_i,

    // Straps: the cache, and the image's layout in bytes.
    input logic [                 SET_BITS-1:0] set_mask_i,      // sets in use - 1
    input logic [       $clog2(MAX_WAYS+1)-1:0] ways_i,          // in use; 0: no cache
    input logic [      $clog2(MAX_MSHRS+1)-1:0] mshrs_i,         // in use, at least 1
    input logic [$clog2(MAX_HIT_LATENCY+1)-1:0] hit_latency_i,   // at least 1
    input logic [             ADDRESS_BITS-1:0] node_base_i,
    input logic [                         12:0] node_stride_i,
    input logic [                         30:0] masked_nodes_i,  // the others are bare
    input logic [             ADDRESS_BITS-1:0] bare_base_i,
    input logic [                         12:0] bare_stride_i,
    input logic [                LANE_BITS-1:0] full_mask_i,     // all ones, or the last index of compressed masks

    // Links.
    input  logic                    requests_valid_i,
    input  logic [SLOT_BITS+31+OF_PACKET:0] requests_data_i,  // ref; with PACKETS whether it is a packet's above
    output logic                    requests_pop_o,
    input  logic                    fills_valid_i,
    input  logic [8*LINE_BYTES+7:0] fills_data_i,      // response
    output logic                    fills_pop_o,
    input  logic                    misses_ready_i,
    output logic                    misses_push_o,
    output logic [ADDRESS_BITS+8:0] misses_data_o,     // request without data
    input  logic                    done_ready_i,
    output logic                    done_push_o,
    output logic [  SLOT_BITS+31:0] done_data_o,       // ref; for both links
    input  logic                    packets_ready_i,   // with PACKETS: the link of packets' nodes
    output logic                    packets_push_o,
    output logic [             3:0] activity_o,

    // The nodes of contexts, a slot for each port.
    input  logic [  READ_PORTS*SLOT_BITS-1:0] node_slot_i,
    // Lo.x of lane 0 lowest, then the other lanes, lo.y ..; of BOX_BITS below 32 above the frame: origin x, y, z lowest,
    // then the exponents.
    output logic [ READ_PORTS*BOXES_BITS-1:0] node_boxes_o,
    output logic [        READ_PORTS*128-1:0] node_children_o,  // references, lane 0 lowest
    output logic [READ_PORTS*4*LANE_BITS-1:0] node_masks_o,     // lane 0 lowest; 0 without masks
    output logic [          READ_PORTS*4-1:0] node_full_o       // bit lane: its mask is full
);
  localparam int SLOTS = 1 << SLOT_BITS;
  localparam int MASK_WORDS = (MASK_BITS + 7) / 8;  // of all four lanes, a byte of each a word
  localparam int BODY_WORDS = BOXES_BITS / 32 + 4;  // boxes and children
  localparam int NODE_WORDS = BODY_WORDS + MASK_WORDS;
  localparam int MASKS_BITS = 4 * LANE_BITS;

  // Where the node lies.
  wire [31:0] reference = requests_data_i[31:0];
  wire bare = reference[30:0] >= masked_nodes_i;
  wire [30:0] index = bare ? reference[30:0] - masked_nodes_i : reference[30:0];
  wire [12:0] stride = bare ? bare_stride_i : node_stride_i;
  wire [ADDRESS_BITS-1:0] first =
      (bare ? bare_base_i : node_base_i) + ADDRESS_BITS'(index) * ADDRESS_BITS'(stride);
  wire [ADDRESS_BITS-1:0] last = first + ADDRESS_BITS'(stride) - ADDRESS_BITS'(1);

  logic [SLOT_BITS-1:0] done_slot;
  logic leaves, leaving_ready;
  logic [32*NODE_WORDS-1:0] node;
  span_fetch #(
      .SLOT_BITS(SLOT_BITS),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(LINE_BYTES),
      .PORTS(PORTS),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS),
      .MAX_MSHRS(MAX_MSHRS),
      .MAX_HIT_LATENCY(MAX_HIT_LATENCY),
      .MAX_SPAN_BYTES(MAX_STRIDE),
      .KEPT_BYTES(4 * NODE_WORDS),
      .READ_WORDS(NODE_WORDS),
      .READ_BITS(1)
  ) fetch (
      .clk_i,
      .rst_i,
      .set_mask_i,
      .ways_i,
      .mshrs_i,
      .hit_latency_i,
      .requests_valid_i,
      .requests_slot_i(requests_data_i[32+:SLOT_BITS]),
      .requests_first_i(first),
      .requests_last_i(last),
      .requests_pop_o,
      .fills_valid_i,
      .fills_data_i,
      .fills_pop_o,
      .misses_ready_i,
      .misses_push_o,
      .misses_data_o,
      .done_ready_i(leaving_ready),
      .done_push_o(leaves),
      .done_slot_o(done_slot),
      .activity_o,
      .read_slot_i(done_slot),
      .read_word_i(1'b0),
      .read_o(node)
  );

  logic [31:0] references_q[SLOTS];
  always_ff @(posedge clk_i) if (requests_pop_o) references_q[requests_data_i[32+:SLOT_BITS]] <= reference;
  wire [31:0] done_reference = references_q[done_slot];
  assign done_data_o = {done_slot, done_reference};
  generate
    if (PACKETS) begin : g_packets
      logic [SLOTS-1:0] of_packet_q;
      always_ff @(posedge clk_i)
        if (requests_pop_o) of_packet_q[requests_data_i[32+:SLOT_BITS]] <= requests_data_i[SLOT_BITS+32];
      wire of_packet = of_packet_q[done_slot];
      assign leaving_ready = of_packet ? packets_ready_i : done_ready_i;
      assign done_push_o = leaves && !of_packet;
      assign packets_push_o = leaves && of_packet;
    end else begin : g_alone
      assign leaving_ready = done_ready_i;
      assign done_push_o = leaves;
      assign packets_push_o = 1'b0;
      wire unused_packets = packets_ready_i;
    end
  endgenerate

  // The node in order: masks of bare ones are full.
  logic [MASKS_BITS-1:0] masks;
  logic [3:0] full;
  generate
    if (MASK_BITS == 0) begin : g_no_masks
      wire unused_full_mask = full_mask_i;
      assign masks = '0;
      assign full = 4'd0;
    end else begin : g_masks
      wire done_bare = done_reference[30:0] >= masked_nodes_i;
      wire unused_padding = &{1'b0, node};  // indices need not fill their bytes
      for (genvar lane = 0; lane < 4; lane++) begin : g_lane
        wire [LANE_BITS-1:0] mask = done_bare ? full_mask_i : node[32*BODY_WORDS+8*MASK_WORDS*lane+:LANE_BITS];
        assign masks[LANE_BITS*lane+:LANE_BITS] = mask;
        assign full[lane] = mask == full_mask_i;
      end
    end
  endgenerate
  logic [BOXES_BITS-1:0] boxes;
  logic [127:0] children;
  generate
    if (BOX_BITS == 32) begin : g_full_boxes
      assign {children, boxes} = node[895:0];
    end else begin : g_compact_boxes  // children lie between frame and planes
      assign {boxes[BOXES_BITS-1:128], children, boxes[127:0]} = node[32*BODY_WORDS-1:0];
    end
  endgenerate
  logic [BOXES_BITS+131+MASKS_BITS:0] nodes_q[SLOTS];
  always_ff @(posedge clk_i) if (leaves) nodes_q[done_slot] <= {full, masks, children, boxes};
  generate
    for (genvar port = 0; port < READ_PORTS; port++) begin : g_port
      assign {node_full_o[4*port+:4], node_masks_o[MASKS_BITS*port+:MASKS_BITS], node_children_o[128*port+:128],
              node_boxes_o[BOXES_BITS*port+:BOXES_BITS]} = nodes_q[node_slot_i[SLOT_BITS*port+:SLOT_BITS]];
    end
  endgenerate
endmodule
