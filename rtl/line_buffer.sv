// line_buffer: the bytes of one span of memory for each context, from the lines that bring them.
//
//   latency a line given in cycle t can be read from t + 1 on
//   twin    none: the model reads the image itself
//
// A context holds LINES lines, all that its span can touch: one more than its bytes fill, as it may begin anywhere in
// the first. A line from memory comes for many contexts at once, lines of the cache for one.
module line_buffer #(
    parameter int SLOT_BITS = 1,
    parameter int LINE_BYTES = 32,
    parameter int PORTS = 1,
    parameter int LINES = 5,
    parameter int ORDINAL_BITS = 3,  // of lines of a span; those from LINES on are not kept
    parameter int READ_WORDS = 28,
    parameter int READ_BITS = 5,     // of word offsets in a span
    parameter int READ_PORTS = 1,
    localparam int SLOTS = 1 << SLOT_BITS,
    localparam int LINE_BITS = 8 * LINE_BYTES,
    localparam int WORD_BITS = $clog2(LINE_BYTES / 4)
) (
    input logic clk_i,

    // A span begins for a context: the number of its first line (lowest bits), and its first word in it.
    input logic                    start_i,
    input logic [   SLOT_BITS-1:0] start_slot_i,
    input logic [ORDINAL_BITS-1:0] start_number_i,
    input logic [   WORD_BITS-1:0] start_word_i,

    // A line from memory for some contexts, by its number.
    input logic [       SLOTS-1:0] fill_i,
    input logic [ORDINAL_BITS-1:0] fill_number_i,
    input logic [   LINE_BITS-1:0] fill_line_i,

    // Lines of the cache for one context, in a row from number hit_ordinal_i of its span on.
    input logic [          PORTS-1:0] hit_i,
    input logic [      SLOT_BITS-1:0] hit_slot_i,
    input logic [   ORDINAL_BITS-1:0] hit_ordinal_i,
    input logic [PORTS*LINE_BITS-1:0] hit_lines_i,

    // READ_WORDS words of a context's span from a word on, for each port.
    input  logic [    READ_PORTS*SLOT_BITS-1:0] read_slot_i,
    input  logic [    READ_PORTS*READ_BITS-1:0] read_word_i,
    output logic [32*READ_PORTS*READ_WORDS-1:0] read_o
);
  localparam int INDEX_BITS = $clog2(SLOTS * LINES);
  localparam int PORT_BITS = PORTS == 1 ? 1 : $clog2(PORTS);

  (* mem2reg *) logic [ORDINAL_BITS-1:0] first_number_q[SLOTS];
  (* mem2reg *) logic [WORD_BITS-1:0] first_word_q[SLOTS];
  (* mem2reg *) logic [LINE_BITS-1:0] lines_q[SLOTS*LINES];

  // Which of the hits is line k of its span.
  logic [LINES-1:0] hits;
  logic [LINES*PORT_BITS-1:0] hit_port;
  always_comb begin
    hits = '0;
    hit_port = '0;
    for (int k = 0; k < LINES; k++) begin
      for (int p = 0; p < PORTS; p++) begin
        if (hit_i[p] && 32'(hit_ordinal_i) + p == k) begin
          hits[k] = 1'b1;
          hit_port[PORT_BITS*k+:PORT_BITS] = PORT_BITS'(p);
        end
      end
    end
  end

  generate
    for (genvar s = 0; s < SLOTS; s++) begin : g_slot
      wire [ORDINAL_BITS-1:0] fill_ordinal = fill_number_i - first_number_q[s];
      always_ff @(posedge clk_i) begin
        if (start_i && 32'(start_slot_i) == s) begin
          first_number_q[s] <= start_number_i;
          first_word_q[s] <= start_word_i;
        end
      end
      for (genvar k = 0; k < LINES; k++) begin : g_line
        always_ff @(posedge clk_i) begin
          if (fill_i[s] && 32'(fill_ordinal) == k) lines_q[s*LINES+k] <= fill_line_i;
          else if (hit_slot_i == SLOT_BITS'(s) && hits[k])
            lines_q[s*LINES+k] <= hit_lines_i[LINE_BITS*hit_port[PORT_BITS*k+:PORT_BITS]+:LINE_BITS];
        end
      end
    end
  endgenerate

  // The lines that hold the words, then the words.
  localparam int READ_LINES = (LINE_BYTES / 4 - 1 + READ_WORDS + LINE_BYTES / 4 - 1) / (LINE_BYTES / 4);
  localparam int AT_BITS = READ_BITS > WORD_BITS ? READ_BITS + 1 : WORD_BITS + 1;
  generate
    for (genvar port = 0; port < READ_PORTS; port++) begin : g_read
      wire [SLOT_BITS-1:0] slot = read_slot_i[SLOT_BITS*port+:SLOT_BITS];
      wire [AT_BITS-1:0] at = AT_BITS'(first_word_q[slot]) + AT_BITS'(read_word_i[READ_BITS*port+:READ_BITS]);
      logic [READ_LINES*LINE_BITS-1:0] read_lines;
      always_comb begin
        for (int i = 0; i < READ_LINES; i++)
          read_lines[LINE_BITS*i+:LINE_BITS] =
              lines_q[INDEX_BITS'(slot)*INDEX_BITS'(LINES)+INDEX_BITS'(at[AT_BITS-1:WORD_BITS])+INDEX_BITS'(i)];
      end
      assign read_o[32*READ_WORDS*port+:32*READ_WORDS] =
          (32 * READ_WORDS)'(read_lines >> {at[WORD_BITS-1:0], 5'd0});
    end
  endgenerate
endmodule
