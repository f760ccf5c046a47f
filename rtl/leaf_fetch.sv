// leaf_fetch: brings the bytes of all primitives of a leaf through leaf_cache, and keeps them by context.
//
//   latency and interval as line_fetch
//   twin    model/pipeline/leaf_fetch.h; addresses as UnitImage::leaf_bytes, triangles as in model/accel/image.h
//   stated  docs/unit.md
//
// A primitive can be read by context and place in its leaf from the cycle in which the leaf leaves, until the next leaf
// of the context is asked for. Address and lines are found in the cycle in which the token is taken.
module leaf_fetch #(
    parameter int SLOT_BITS = 1,
    parameter int ADDRESS_BITS = 32,
    parameter int LINE_BYTES = 32,
    parameter int PORTS = 1,            // lines looked up in a cycle
    parameter int MAX_SETS = 2,         // of the cache, a power of two
    parameter int MAX_WAYS = 2,
    parameter int MAX_MSHRS = 4,
    parameter int MAX_HIT_LATENCY = 4,
    parameter int MAX_LEAF_BYTES = 80,  // primitives at most * stride
    parameter int READ_PORTS = 1,       // primitives read at once
    parameter int READ_WORDS = 10,      // of each: 10, or 16 with its box
    localparam int SET_BITS = MAX_SETS == 1 ? 1 : $clog2(MAX_SETS)
) (
    input logic clk_i,
    input logic rst_i,

    // Straps: the cache, and the image's layout in bytes.
    input logic [                 SET_BITS-1:0] set_mask_i,         // sets in use - 1
    input logic [       $clog2(MAX_WAYS+1)-1:0] ways_i,             // in use; 0: no cache
    input logic [      $clog2(MAX_MSHRS+1)-1:0] mshrs_i,            // in use, at least 1
    input logic [$clog2(MAX_HIT_LATENCY+1)-1:0] hit_latency_i,      // at least 1
    input logic [             ADDRESS_BITS-1:0] triangle_base_i,
    input logic [                         12:0] triangle_stride_i,  // a multiple of 4

    // Links.
    input  logic                    requests_valid_i,
    input  logic [  SLOT_BITS+31:0] requests_data_i,   // ref
    output logic                    requests_pop_o,
    input  logic                    fills_valid_i,
    input  logic [8*LINE_BYTES+7:0] fills_data_i,      // response
    output logic                    fills_pop_o,
    input  logic                    misses_ready_i,
    output logic                    misses_push_o,
    output logic [ADDRESS_BITS+8:0] misses_data_o,     // request without data
    input  logic                    done_ready_i,
    output logic                    done_push_o,
    output logic [  SLOT_BITS+31:0] done_data_o,       // ref
    output logic [             3:0] activity_o,

    // Primitives of contexts' leaves, the first port's lowest: v0.x lowest, then v0.y, v0.z, v1, v2, primitive, box.
    input  logic [    READ_PORTS*SLOT_BITS-1:0] triangle_slot_i,
    input  logic [            READ_PORTS*4-1:0] triangle_index_i,
    output logic [READ_PORTS*32*READ_WORDS-1:0] triangle_o
);
  localparam int SLOTS = 1 << SLOT_BITS;
  localparam int READ_BITS = $clog2(MAX_LEAF_BYTES / 4) + 1;

  // Where the leaf lies.
  wire [31:0] reference = requests_data_i[31:0];
  wire [ADDRESS_BITS-1:0] first =
      triangle_base_i + ADDRESS_BITS'(reference[26:0]) * ADDRESS_BITS'(triangle_stride_i);
  wire [17:0] bytes = (18'(reference[30:27]) + 18'd1) * 18'(triangle_stride_i);
  wire [ADDRESS_BITS-1:0] last = first + ADDRESS_BITS'(bytes) - ADDRESS_BITS'(1);

  logic [READ_PORTS*READ_BITS-1:0] triangle_word;
  generate
    for (genvar port = 0; port < READ_PORTS; port++) begin : g_port
      assign triangle_word[READ_BITS*port+:READ_BITS] =
          READ_BITS'(triangle_index_i[4*port+:4]) * READ_BITS'(triangle_stride_i[12:2]);
    end
  endgenerate
  wire unused_stride = &{1'b0, triangle_stride_i[1:0]};

  logic [SLOT_BITS-1:0] done_slot;
  span_fetch #(
      .SLOT_BITS(SLOT_BITS),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(LINE_BYTES),
      .PORTS(PORTS),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS),
      .MAX_MSHRS(MAX_MSHRS),
      .MAX_HIT_LATENCY(MAX_HIT_LATENCY),
      .MAX_SPAN_BYTES(MAX_LEAF_BYTES),
      .KEPT_BYTES(MAX_LEAF_BYTES),
      .READ_WORDS(READ_WORDS),
      .READ_BITS(READ_BITS),
      .READ_PORTS(READ_PORTS)
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
      .done_ready_i,
      .done_push_o,
      .done_slot_o(done_slot),
      .activity_o,
      .read_slot_i(triangle_slot_i),
      .read_word_i(triangle_word),
      .read_o(triangle_o)
  );

  logic [31:0] references_q[SLOTS];
  always_ff @(posedge clk_i) if (requests_pop_o) references_q[requests_data_i[32+:SLOT_BITS]] <= reference;
  assign done_data_o = {done_slot, references_q[done_slot]};
endmodule
