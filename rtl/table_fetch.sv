// table_fetch: brings the rows of tables that lie in memory through table_cache, for the lanes that are asked, and keeps
// them by context. There for designs with tables only.
//
//   latency and interval as line_fetch; a node without reads leaves in the cycle behind the one in which it is taken
//   twin    model/pipeline/table_fetch.h; lines and bytes as model/pipeline/table_lines.h, rows as OnChipTables::reads
//   stated  docs/unit.md
//
// The lines of a node's reads are found in the cycle in which the node is taken, from the keys of its lanes: lane by
// lane, in a lane rows by key first, then the entry of the compression LUT, each line once. dedup's rows are looked up
// in a second round, by the ids that the first one has brought. Rows can be read from the cycle in which the node
// leaves, until the next node of the context is taken.
//
// Table t lies from table_base_i[t] on, which begins a line; a row begins at the next multiple of its bytes rounded up to
// a power of two, so that only a row wider than a line lies in two. Of a bit row only the byte with the lane's bit is
// brought.
`include "mask_designs.svh"
`include "tokens.svh"

module table_fetch #(
    parameter int DESIGN = `CTU_DESIGN_PROJECTION,
    parameter int R = 4,
    parameter int R_RAY = 4,
    parameter int ENTRIES = 0,            // of the compression LUT at most; 0: object masks are not compressed
    parameter int ROWS = `CTU_ROWS_ALL,
    parameter int DISTINCT = 1270,        // rows of dedup's second table
    parameter int PROJECTION_TABLES = 3,  // or 1
    parameter int SLOT_BITS = 1,
    parameter int ADDRESS_BITS = 32,
    parameter int LINE_BYTES = 32,
    parameter int PORTS = 1,              // lines looked up in a cycle
    parameter int MAX_SETS = 2,           // of the cache, a power of two
    parameter int MAX_WAYS = 2,
    parameter int MAX_MSHRS = 4,
    parameter int MAX_HIT_LATENCY = 4,
    // Follow from these:
    localparam int SET_BITS = MAX_SETS == 1 ? 1 : $clog2(MAX_SETS),
    localparam int INDEX_BITS = ENTRIES > 1 ? $clog2(ENTRIES) : 1,
    localparam int FETCHED_BITS = `CTU_FETCHED_BITS(DESIGN, R, ENTRIES, ROWS)
) (
    input logic clk_i,
    input logic rst_i,

    // Straps: the cache, and where the tables lie.
    input logic [                 SET_BITS-1:0] set_mask_i,       // sets in use - 1
    input logic [       $clog2(MAX_WAYS+1)-1:0] ways_i,           // in use; 0: no cache
    input logic [      $clog2(MAX_MSHRS+1)-1:0] mshrs_i,          // in use, at least 1
    input logic [$clog2(MAX_HIT_LATENCY+1)-1:0] hit_latency_i,    // at least 1
    input logic [           4*ADDRESS_BITS-1:0] table_base_i,     // of each table, the first one lowest
    input logic [                          3:0] bit_row_shift_i,  // a bit row takes 1 << this bytes

    // Links.
    input  logic                                   requests_valid_i,
    input  logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] requests_data_i,
    output logic                                   requests_pop_o,
    input  logic                                   fills_valid_i,
    input  logic [              8*LINE_BYTES+7:0] fills_data_i,     // response
    output logic                                   fills_pop_o,
    input  logic                                   misses_ready_i,
    output logic                                   misses_push_o,
    output logic [              ADDRESS_BITS+8:0] misses_data_o,    // request without data
    input  logic                                   done_ready_i,
    output logic                                   done_push_o,
    output logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] done_data_o,
    output logic [                            3:0] activity_o,

    // Keys {uncertain, end, begin} and indices into the compression LUT of the node that is looked up; the first lane
    // lowest.
    output logic [   SLOT_BITS-1:0] key_slot_o,
    input  logic [         4*31-1:0] key_i,
    input  logic [4*INDEX_BITS-1:0] index_i,

    // What the lanes of a context read (CTU_FETCHED_BITS), the first lane lowest.
    input  logic [     SLOT_BITS-1:0] row_slot_i,
    output logic [4*FETCHED_BITS-1:0] row_o
);
  localparam int SLOTS = 1 << SLOT_BITS;
  localparam int LINE_SHIFT = $clog2(LINE_BYTES);
  localparam int LINE_NUMBER_BITS = ADDRESS_BITS - LINE_SHIFT;
  localparam int LINE_BITS = 8 * LINE_BYTES;
  localparam int CELLS = R * R * R;
  localparam bit IS_KEYED = DESIGN != `CTU_DESIGN_COMPARATORS;
  localparam bit IS_DEDUP = DESIGN == `CTU_DESIGN_DEDUP;
  localparam bit BIT_ROWS = `CTU_BIT_ROWS(DESIGN, ENTRIES);
  localparam bit HAS_LUT = `CTU_READS_LUT(DESIGN, ENTRIES);
  localparam int ID_MIRROR_BITS = `CTU_ID_MIRROR_BITS(DESIGN, ENTRIES, ROWS);
  localparam int ID_BITS = DISTINCT > 1 ? $clog2(DISTINCT) : 1;
  localparam int ROW_BITS = $clog2(`CTU_KEY_ROWS(DESIGN, R_RAY, ENTRIES, ROWS));
  localparam int ROWS_OF_LANE = `CTU_ROWS_OF_LANE(DESIGN);

  // Reads of a lane in a round: by key, then of the compression LUT.
  localparam int KEY_READS = IS_KEYED ? ROWS_OF_LANE : 0;
  localparam int LANE_READS = KEY_READS + (HAS_LUT ? 1 : 0);
  localparam int READS = 4 * LANE_READS;
  localparam int LUT_TABLE = !IS_KEYED ? 0 : DESIGN == `CTU_DESIGN_PROJECTION ? PROJECTION_TABLES : 1;
  // Bits that a read brings, and bytes from row to row.
  localparam int ROW_WIDTH = BIT_ROWS ? 8 : `CTU_ROW_WIDTH(DESIGN, R, ENTRIES);
  localparam int ID_WIDTH = ID_BITS + ID_MIRROR_BITS;
  localparam int ROW_SHIFT = $clog2((ROW_WIDTH + 7) / 8);
  localparam int ID_SHIFT = $clog2((ID_WIDTH + 7) / 8);
  localparam int LUT_SHIFT = $clog2((CELLS + 7) / 8);
  localparam int MAX_WIDTH = HAS_LUT ? CELLS : ROW_WIDTH;
  localparam int PARTS = (MAX_WIDTH + LINE_BITS - 1) / LINE_BITS;  // lines of a read at most
  localparam int LINES = READS * PARTS;

  // The node that is looked up.
  logic starts, second, unused_look;
  logic [SLOT_BITS-1:0] slot;
  logic [`CTU_NODE_FIELDS-1:0] fields_q[SLOTS];
  always_ff @(posedge clk_i)
    if (requests_pop_o)
      fields_q[requests_data_i[`CTU_NODE_FIELDS+:SLOT_BITS]] <= requests_data_i[`CTU_NODE_FIELDS-1:0];
  wire [3:0] asked = second ? fields_q[slot][3:0] : requests_data_i[3:0];
  assign key_slot_o = slot;

  // Where each read lies: the line, and the byte in it.
  logic [3:0] reads;  // lanes that read
  logic [READS*LINE_NUMBER_BITS-1:0] first_lines;
  logic [READS*LINE_SHIFT-1:0] offsets;
  logic [4*ID_BITS-1:0] ids;
  generate
    for (genvar lane = 0; lane < 4; lane++) begin : g_lane
      wire [INDEX_BITS-1:0] index = index_i[INDEX_BITS*lane+:INDEX_BITS];
      wire [ADDRESS_BITS-1:0] byte_of_bit = ADDRESS_BITS'(index) >> 3;
      logic [ROWS_OF_LANE*ROW_BITS-1:0] rows;
      if (IS_KEYED) begin : g_keyed
        logic left_out;
        logic [ROWS_OF_LANE*(DESIGN==`CTU_DESIGN_PROJECTION?2:3)-1:0] unused_mirrored;
        lane_rows #(
            .DESIGN(DESIGN),
            .R_RAY(R_RAY),
            .ENTRIES(ENTRIES),
            .ROWS(ROWS)
        ) rows_of_key (
            .key_i(key_i[31*lane+:30]),
            .row_o(rows),
            .mirrored_o(unused_mirrored),
            .left_out_o(left_out)
        );
        assign reads[lane] = asked[lane] && !key_i[31*lane+30] && !left_out;
      end else begin : g_cells
        assign rows = '0;
        assign reads[lane] = asked[lane];
      end
      for (genvar k = 0; k < LANE_READS; k++) begin : g_read
        localparam int READ = LANE_READS * lane + k;
        // From the table's first byte on.
        logic [ADDRESS_BITS-1:0] place;
        logic [LINE_NUMBER_BITS-1:0] table_line;
        if (k == KEY_READS) begin : g_lut
          assign place = ADDRESS_BITS'(index) << LUT_SHIFT;
          assign table_line = table_base_i[ADDRESS_BITS*LUT_TABLE+LINE_SHIFT+:LINE_NUMBER_BITS];
        end else if (IS_DEDUP) begin : g_dedup
          wire [ADDRESS_BITS-1:0] id = ADDRESS_BITS'(ids[ID_BITS*lane+:ID_BITS]);
          assign place = !second ? ADDRESS_BITS'(rows) << ID_SHIFT :
              BIT_ROWS ? (id << bit_row_shift_i) + byte_of_bit : id << ROW_SHIFT;
          assign table_line = second ? table_base_i[ADDRESS_BITS+LINE_SHIFT+:LINE_NUMBER_BITS] :
              table_base_i[LINE_SHIFT+:LINE_NUMBER_BITS];
        end else begin : g_row
          localparam int TABLE = PROJECTION_TABLES == 3 ? k : 0;
          wire [ADDRESS_BITS-1:0] row = ADDRESS_BITS'(rows[ROW_BITS*k+:ROW_BITS]);
          assign place = BIT_ROWS ? (row << bit_row_shift_i) + byte_of_bit : row << ROW_SHIFT;
          assign table_line = table_base_i[ADDRESS_BITS*TABLE+LINE_SHIFT+:LINE_NUMBER_BITS];
        end
        assign first_lines[LINE_NUMBER_BITS*READ+:LINE_NUMBER_BITS] =
            table_line + place[ADDRESS_BITS-1:LINE_SHIFT];
        assign offsets[LINE_SHIFT*READ+:LINE_SHIFT] = place[LINE_SHIFT-1:0];
      end
      wire unused_lane = &{1'b0, rows, byte_of_bit, ids};
    end
  endgenerate
  wire unused_straps = &{1'b0, table_base_i, bit_row_shift_i, key_i, index_i};

  // All lines of the round, and which of them come first.
  logic [LINES*LINE_NUMBER_BITS-1:0] all_lines, lines_q;
  logic [LINES-1:0] wanted, distinct, pending_q;
  generate
    for (genvar i = 0; i < LINES; i++) begin : g_line
      localparam int READ = i / PARTS;
      localparam int PART = i % PARTS;
      localparam int WIDTH = READ % LANE_READS == KEY_READS ? CELLS : ROW_WIDTH;
      wire [LINE_NUMBER_BITS-1:0] number =
          first_lines[LINE_NUMBER_BITS*READ+:LINE_NUMBER_BITS] + LINE_NUMBER_BITS'(PART);
      assign all_lines[LINE_NUMBER_BITS*i+:LINE_NUMBER_BITS] = number;
      if (PART == 0) assign wanted[i] = reads[READ/LANE_READS];
      else assign wanted[i] = reads[READ/LANE_READS] && PART * LINE_BITS < WIDTH && (!IS_DEDUP || second);
      logic [LINES-1:0] same;
      for (genvar j = 0; j < LINES; j++) begin : g_earlier
        if (j < i) assign same[j] = wanted[j] && all_lines[LINE_NUMBER_BITS*j+:LINE_NUMBER_BITS] == number;
        else assign same[j] = 1'b0;
      end
`ifdef CTU_MUTATE_TABLE_LINES_REPEATED
      assign distinct[i] = wanted[i];
      wire unused_same = &{1'b0, same};
`else
      assign distinct[i] = wanted[i] && same == '0;
`endif
    end
  endgenerate

  // Those still to be looked up, PORTS a cycle.
  logic [LINES-1:0] pending, left;
  logic [PORTS*LINES-1:0] chosen;  // a line for each port
  logic [PORTS*LINE_NUMBER_BITS-1:0] lines;
  logic [PORTS-1:0] last, looked_up, hits;
  assign pending = starts ? distinct : pending_q;
  always_comb begin : choose
    logic [LINES-1:0] rest, first;
    rest = pending;
    lines = '0;
    for (int p = 0; p < PORTS; p++) begin
      first = rest & (~rest + LINES'(1));
      rest = rest & ~first;
      chosen[LINES*p+:LINES] = first;
      last[p] = rest == '0;
      for (int i = 0; i < LINES; i++)
        if (first[i])
          lines[LINE_NUMBER_BITS*p+:LINE_NUMBER_BITS] = starts ? all_lines[LINE_NUMBER_BITS*i+:LINE_NUMBER_BITS] :
              lines_q[LINE_NUMBER_BITS*i+:LINE_NUMBER_BITS];
    end
  end
  always_comb begin
    left = pending;
    for (int p = 0; p < PORTS; p++) if (looked_up[p]) left = left & ~chosen[LINES*p+:LINES];
  end
  always_ff @(posedge clk_i) begin
    pending_q <= left;
    if (starts) lines_q <= all_lines;
  end

  logic [SLOT_BITS-1:0] done_slot;
  logic [PORTS*LINE_BITS-1:0] hit_lines;
  logic [LINE_NUMBER_BITS-1:0] fill_number;
  logic [SLOTS-1:0] fill_waiters;
  line_fetch #(
      .SLOT_BITS(SLOT_BITS),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(LINE_BYTES),
      .PORTS(PORTS),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS),
      .MAX_MSHRS(MAX_MSHRS),
      .MAX_HIT_LATENCY(MAX_HIT_LATENCY),
      .MAX_LINES(LINES),
      .TWO_ROUNDS(IS_DEDUP)
  ) core (
      .clk_i,
      .rst_i,
      .set_mask_i,
      .ways_i,
      .mshrs_i,
      .hit_latency_i,
      .two_rounds_i(IS_DEDUP),
      .requests_valid_i,
      .requests_slot_i(requests_data_i[`CTU_NODE_FIELDS+:SLOT_BITS]),
      .requests_pop_o,
      .fills_valid_i,
      .fills_id_i(fills_data_i[LINE_BITS+:8]),
      .fills_line_i(fills_data_i[LINE_BITS-1:0]),
      .fills_pop_o,
      .misses_ready_i,
      .misses_push_o,
      .misses_data_o,
      .done_ready_i,
      .done_push_o,
      .done_slot_o(done_slot),
      .activity_o,
      .look_o(unused_look),
      .starts_o(starts),
      .second_o(second),
      .slot_o(slot),
      .none_i(starts && distinct == '0),
      .lines_i(lines),
      .last_i(last),
      .looked_up_o(looked_up),
      .hit_o(hits),
      .hit_data_o(hit_lines),
      .fill_number_o(fill_number),
      .fill_waiters_o(fill_waiters)
  );
  assign done_data_o = {done_slot, fields_q[done_slot]};

  // Hits come from the cache in the next cycle.
  logic [PORTS-1:0] hits_q;
  logic [SLOT_BITS-1:0] hit_slot_q;
  logic [PORTS*LINE_NUMBER_BITS-1:0] hit_numbers_q;
  always_ff @(posedge clk_i) begin
    hits_q <= rst_i ? '0 : hits;
    hit_slot_q <= slot;
    hit_numbers_q <= lines;
  end

  // What the reads bring. A context's rows of dedup are where they lie only from its second round on.
  generate
    for (genvar lane = 0; lane < 4; lane++) begin : g_rows
      for (genvar k = 0; k < LANE_READS; k++) begin : g_read
        localparam int READ = LANE_READS * lane + k;
        localparam int WIDTH = k == KEY_READS ? CELLS : ROW_WIDTH;
        row_buffer #(
            .SLOT_BITS(SLOT_BITS),
            .LINE_NUMBER_BITS(LINE_NUMBER_BITS),
            .LINE_BYTES(LINE_BYTES),
            .PORTS(PORTS),
            .WIDTH(WIDTH)
        ) rows (
            .clk_i,
            .start_i(starts && (!IS_DEDUP || second)),
            .start_slot_i(slot),
            .start_line_i(first_lines[LINE_NUMBER_BITS*READ+:LINE_NUMBER_BITS]),
            .start_offset_i(offsets[LINE_SHIFT*READ+:LINE_SHIFT]),
            .fill_i(fill_waiters),
            .fill_number_i(fill_number),
            .fill_line_i(fills_data_i[LINE_BITS-1:0]),
            .hit_i(hits_q),
            .hit_slot_i(hit_slot_q),
            .hit_numbers_i(hit_numbers_q),
            .hit_lines_i(hit_lines),
            .read_slot_i(row_slot_i),
            .read_o(row_o[FETCHED_BITS*lane+ID_MIRROR_BITS+ROW_WIDTH*k+:WIDTH])
        );
      end
      if (IS_DEDUP) begin : g_id
        // Read for the second round, and for how it is mirrored beside the row.
        logic [2*ID_WIDTH-1:0] id;
        row_buffer #(
            .SLOT_BITS(SLOT_BITS),
            .LINE_NUMBER_BITS(LINE_NUMBER_BITS),
            .LINE_BYTES(LINE_BYTES),
            .PORTS(PORTS),
            .WIDTH(ID_WIDTH),
            .READS(2)
        ) rows (
            .clk_i,
            .start_i(starts && !second),
            .start_slot_i(slot),
            .start_line_i(first_lines[LINE_NUMBER_BITS*lane+:LINE_NUMBER_BITS]),
            .start_offset_i(offsets[LINE_SHIFT*lane+:LINE_SHIFT]),
            .fill_i(fill_waiters),
            .fill_number_i(fill_number),
            .fill_line_i(fills_data_i[LINE_BITS-1:0]),
            .hit_i(hits_q),
            .hit_slot_i(hit_slot_q),
            .hit_numbers_i(hit_numbers_q),
            .hit_lines_i(hit_lines),
            .read_slot_i({row_slot_i, slot}),
            .read_o(id)
        );
        assign ids[ID_BITS*lane+:ID_BITS] = id[ID_WIDTH-1:ID_MIRROR_BITS];
        if (ID_MIRROR_BITS > 0) assign row_o[FETCHED_BITS*lane+:ID_MIRROR_BITS] = id[ID_WIDTH+:ID_MIRROR_BITS];
        wire unused_id = &{1'b0, id};
      end else begin : g_no_id
        assign ids[ID_BITS*lane+:ID_BITS] = '0;
      end
    end
  endgenerate
endmodule
