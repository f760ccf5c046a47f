// row_buffer: the bits of one row of a table for each context, from the lines of memory that bring them.
//
//   latency a line given in cycle t can be read from t + 1 on
//   twin    none: the model reads the tables themselves
//
// A context is told at the start of a fetch in which line and where in it its row lies; a row wider than a line begins
// one and goes on in the next. What comes later from these lines is the same again.
module row_buffer #(
    parameter int SLOT_BITS = 1,
    parameter int LINE_NUMBER_BITS = 27,
    parameter int LINE_BYTES = 32,
    parameter int PORTS = 1,
    parameter int WIDTH = 16,             // bits of a row
    parameter int READS = 1,
    localparam int SLOTS = 1 << SLOT_BITS,
    localparam int LINE_BITS = 8 * LINE_BYTES,
    localparam int OFFSET_BITS = $clog2(LINE_BYTES)
) (
    input logic clk_i,

    // Where the row of a context lies: line and byte.
    input logic                        start_i,
    input logic [       SLOT_BITS-1:0] start_slot_i,
    input logic [LINE_NUMBER_BITS-1:0] start_line_i,
    input logic [     OFFSET_BITS-1:0] start_offset_i,

    // A line from memory for some contexts.
    input logic [           SLOTS-1:0] fill_i,
    input logic [LINE_NUMBER_BITS-1:0] fill_number_i,
    input logic [       LINE_BITS-1:0] fill_line_i,

    // Lines of the cache for one context.
    input logic [                 PORTS-1:0] hit_i,
    input logic [             SLOT_BITS-1:0] hit_slot_i,
    input logic [PORTS*LINE_NUMBER_BITS-1:0] hit_numbers_i,
    input logic [       PORTS*LINE_BITS-1:0] hit_lines_i,

    // The rows of contexts.
    input  logic [READS*SLOT_BITS-1:0] read_slot_i,
    output logic [    READS*WIDTH-1:0] read_o
);
  localparam int PARTS = (WIDTH + LINE_BITS - 1) / LINE_BITS;  // lines of a row
  localparam int PART_BITS = WIDTH < LINE_BITS ? WIDTH : LINE_BITS;

  (* mem2reg *) logic [LINE_NUMBER_BITS-1:0] line_q[SLOTS];
  (* mem2reg *) logic [OFFSET_BITS-1:0] offset_q[SLOTS];
  generate
    for (genvar s = 0; s < SLOTS; s++) begin : g_slot
      always_ff @(posedge clk_i) begin
        if (start_i && 32'(start_slot_i) == s) begin
          line_q[s] <= start_line_i;
          offset_q[s] <= start_offset_i;
        end
      end
    end
    for (genvar part = 0; part < PARTS; part++) begin : g_part
      localparam int BITS = part == PARTS - 1 ? WIDTH - part * LINE_BITS : LINE_BITS;
      (* mem2reg *) logic [PART_BITS-1:0] row_q[SLOTS];
      for (genvar s = 0; s < SLOTS; s++) begin : g_slot
        wire [LINE_NUMBER_BITS-1:0] number = line_q[s] + LINE_NUMBER_BITS'(part);
        // A row wider than a line begins one.
`ifdef CTU_MUTATE_ROW_OFFSET_IGNORED
        wire [OFFSET_BITS+2:0] first = '0;
`else
        wire [OFFSET_BITS+2:0] first = PARTS == 1 ? {offset_q[s], 3'd0} : '0;
`endif
        always_ff @(posedge clk_i) begin
          if (fill_i[s] && number == fill_number_i) row_q[s] <= fill_line_i[first+:PART_BITS];
          if (hit_i != '0 && 32'(hit_slot_i) == s) begin
            for (int p = 0; p < PORTS; p++)
              if (hit_i[p] && number == hit_numbers_i[LINE_NUMBER_BITS*p+:LINE_NUMBER_BITS])
                row_q[s] <= PART_BITS'(hit_lines_i[LINE_BITS*p+:LINE_BITS] >> first);
          end
        end
      end
      for (genvar r = 0; r < READS; r++) begin : g_read
        assign read_o[WIDTH*r+LINE_BITS*part+:BITS] = BITS'(row_q[read_slot_i[SLOT_BITS*r+:SLOT_BITS]]);
      end
    end
  endgenerate
endmodule
