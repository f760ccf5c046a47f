// span_fetch: brings the lines of one span of bytes for each context, and keeps the bytes; what node_fetch and
// leaf_fetch have in common. They say where the span of a token lies, in the cycle in which it is taken.
//
//   latency and twin as line_fetch, with SpanLines (model/pipeline/span_lines.h)
module span_fetch #(
    parameter int SLOT_BITS = 1,
    parameter int ADDRESS_BITS = 32,
    parameter int LINE_BYTES = 32,
    parameter int PORTS = 1,
    parameter int MAX_SETS = 2,
    parameter int MAX_WAYS = 2,
    parameter int MAX_MSHRS = 4,
    parameter int MAX_HIT_LATENCY = 4,
    parameter int MAX_SPAN_BYTES = 116,  // asked for, at most
    parameter int KEPT_BYTES = 116,      // of the span, from its first one on; the others are padding
    parameter int READ_WORDS = 29,
    parameter int READ_BITS = 1,
    parameter int READ_PORTS = 1,
    localparam int SET_BITS = MAX_SETS == 1 ? 1 : $clog2(MAX_SETS)
) (
    input logic clk_i,
    input logic rst_i,

    // Straps: as in line_fetch.
    input logic [                 SET_BITS-1:0] set_mask_i,
    input logic [       $clog2(MAX_WAYS+1)-1:0] ways_i,
    input logic [      $clog2(MAX_MSHRS+1)-1:0] mshrs_i,
    input logic [$clog2(MAX_HIT_LATENCY+1)-1:0] hit_latency_i,

    // Links.
    input  logic                    requests_valid_i,
    input  logic [   SLOT_BITS-1:0] requests_slot_i,
    input  logic [ADDRESS_BITS-1:0] requests_first_i,  // byte addresses of the span, the first one a multiple of 4
    input  logic [ADDRESS_BITS-1:0] requests_last_i,
    output logic                    requests_pop_o,
    input  logic                    fills_valid_i,
    input  logic [8*LINE_BYTES+7:0] fills_data_i,      // {id, line}
    output logic                    fills_pop_o,
    input  logic                    misses_ready_i,
    output logic                    misses_push_o,
    output logic [ADDRESS_BITS+8:0] misses_data_o,     // {address, id, write = 0}
    input  logic                    done_ready_i,
    output logic                    done_push_o,
    output logic [   SLOT_BITS-1:0] done_slot_o,
    output logic [             3:0] activity_o,

    // READ_WORDS words of a context's span from a word on, for each port; complete from the cycle in which it is done.
    input  logic [    READ_PORTS*SLOT_BITS-1:0] read_slot_i,
    input  logic [    READ_PORTS*READ_BITS-1:0] read_word_i,
    output logic [32*READ_PORTS*READ_WORDS-1:0] read_o
);
  localparam int LINE_SHIFT = $clog2(LINE_BYTES);
  localparam int LINE_NUMBER_BITS = ADDRESS_BITS - LINE_SHIFT;
  localparam int MAX_LINES = (MAX_SPAN_BYTES - 4 + LINE_BYTES - 1) / LINE_BYTES + 1;
  localparam int LINES = (KEPT_BYTES - 4 + LINE_BYTES - 1) / LINE_BYTES + 1;
  localparam int ORDINAL_BITS = $clog2(MAX_LINES + 1);

  // The next line of the token, its last one, and how many come before it.
  logic [LINE_NUMBER_BITS-1:0] line_q, last_line_q;
  logic [ORDINAL_BITS-1:0] ordinal_q;
  logic starts, unused_look, unused_second;
  logic [SLOT_BITS-1:0] slot;
  logic [PORTS-1:0] looked_up, hits, last;
  logic [PORTS*LINE_NUMBER_BITS-1:0] lines;
  logic [LINE_NUMBER_BITS-1:0] line, last_line;
  logic [ORDINAL_BITS-1:0] ordinal;
  logic [$clog2(PORTS+1)-1:0] count;
  always_comb begin
    line = starts ? requests_first_i[ADDRESS_BITS-1:LINE_SHIFT] : line_q;
    last_line = starts ? requests_last_i[ADDRESS_BITS-1:LINE_SHIFT] : last_line_q;
    ordinal = starts ? '0 : ordinal_q;
    for (int p = 0; p < PORTS; p++) begin
      lines[LINE_NUMBER_BITS*p+:LINE_NUMBER_BITS] = line + LINE_NUMBER_BITS'(p);
      last[p] = lines[LINE_NUMBER_BITS*p+:LINE_NUMBER_BITS] == last_line;
    end
  end
  always_comb begin
    count = '0;
    for (int p = 0; p < PORTS; p++) if (looked_up[p]) count = $clog2(PORTS + 1)'(p + 1);
  end
  always_ff @(posedge clk_i) begin
    line_q <= line + LINE_NUMBER_BITS'(count);
    last_line_q <= last_line;
    ordinal_q <= ordinal + ORDINAL_BITS'(count);
  end

  logic [PORTS*8*LINE_BYTES-1:0] hit_lines;
  logic [LINE_NUMBER_BITS-1:0] fill_number;
  logic [(1<<SLOT_BITS)-1:0] fill_waiters;
  wire unused_offsets = &{1'b0, requests_first_i[1:0], requests_last_i[LINE_SHIFT-1:0], fill_number};
  line_fetch #(
      .SLOT_BITS(SLOT_BITS),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(LINE_BYTES),
      .PORTS(PORTS),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS),
      .MAX_MSHRS(MAX_MSHRS),
      .MAX_HIT_LATENCY(MAX_HIT_LATENCY),
      .MAX_LINES(MAX_LINES)
  ) core (
      .clk_i,
      .rst_i,
      .set_mask_i,
      .ways_i,
      .mshrs_i,
      .hit_latency_i,
      .two_rounds_i(1'b0),
      .requests_valid_i,
      .requests_slot_i,
      .requests_pop_o,
      .fills_valid_i,
      .fills_id_i(fills_data_i[8*LINE_BYTES+:8]),
      .fills_line_i(fills_data_i[8*LINE_BYTES-1:0]),
      .fills_pop_o,
      .misses_ready_i,
      .misses_push_o,
      .misses_data_o,
      .done_ready_i,
      .done_push_o,
      .done_slot_o,
      .activity_o,
      .look_o(unused_look),
      .starts_o(starts),
      .second_o(unused_second),
      .slot_o(slot),
      .none_i(1'b0),
      .lines_i(lines),
      .last_i(last),
      .looked_up_o(looked_up),
      .hit_o(hits),
      .hit_data_o(hit_lines),
      .fill_number_o(fill_number),
      .fill_waiters_o(fill_waiters)
  );

  // Hits come from the cache in the next cycle.
  logic [PORTS-1:0] hits_q;
  logic [SLOT_BITS-1:0] hit_slot_q;
  logic [ORDINAL_BITS-1:0] hit_ordinal_q;
  always_ff @(posedge clk_i) begin
    hits_q <= rst_i ? '0 : hits;
    hit_slot_q <= slot;
    hit_ordinal_q <= ordinal;
  end
  line_buffer #(
      .SLOT_BITS(SLOT_BITS),
      .LINE_BYTES(LINE_BYTES),
      .PORTS(PORTS),
      .LINES(LINES),
      .ORDINAL_BITS(ORDINAL_BITS),
      .READ_WORDS(READ_WORDS),
      .READ_BITS(READ_BITS),
      .READ_PORTS(READ_PORTS)
  ) buffer (
      .clk_i,
      .start_i(requests_pop_o),
      .start_slot_i(slot),
      .start_number_i(ORDINAL_BITS'(line)),
      .start_word_i(requests_first_i[LINE_SHIFT-1:2]),
      .fill_i(fill_waiters),
      .fill_number_i(ORDINAL_BITS'(fill_number)),
      .fill_line_i(fills_data_i[8*LINE_BYTES-1:0]),
      .hit_i(hits_q),
      .hit_slot_i(hit_slot_q),
      .hit_ordinal_i(hit_ordinal_q),
      .hit_lines_i(hit_lines),
      .read_slot_i,
      .read_word_i,
      .read_o
  );
endmodule
