// mask_test: does the ray touch an occupied cell? Reads what the design's tables hold for the key of each lane asked
// (or takes the cells that comparators found) and ANDs it with the lane's object mask, which compressed masks fetch
// from the compression LUT by the lane's index; or reads the answer as one bit of a row.
//
//   latency LATENCY, and SECOND_LATENCY more for dedup's tables on chip; a node whose reads do not fit the banks' ports
//           keeps the entrance for more cycles (table_memory)
//   twin    model/pipeline/mask_test.h, table_banks.h, ExecSource::mask_test (model/pipeline/exec_source.cpp)
//   stated  docs/unit.md
//
// Lanes not asked and lanes whose key is uncertain survive without a read. The rows stand in the first register of
// the pipeline, which is the memories' own; they are tested in the cycle in which they stand there, and what is left of
// the latency carries the answer. dedup's second memory is read with what stands in that register; how many turns
// that takes is known only then, which is in time: the entrance is kept for the turns of both memories less one.
//
// Keys are read in the cycle of the pop; object masks and touched cells where the rows meet them, one cycle behind the
// last turn of reads, by the slot of that token; the indices that read the compression LUT in the cycle of the pop.
// A host fills the tables before it lets rays in: memories are numbered and rows have the content of
// cull::TableContent (model/cull/table_content.h). Rows of tables that are CACHED lie beside the node and are read like
// object masks; there are no banks then, and no memories here.
`include "mask_designs.svh"
`include "tokens.svh"

module mask_test #(
    parameter int DESIGN = `CTU_DESIGN_PROJECTION,
    parameter int R = 4,
    parameter int R_RAY = 4,
    parameter int ENTRIES = 0,             // of the compression LUT at most; 0: object masks are not compressed
    parameter int DISTINCT = 1270,         // masks or bit rows of dedup at most
    parameter int PROJECTION_TABLES = 3,   // or 1
    parameter int ROWS = `CTU_ROWS_ALL,
    parameter int BANKS = 4,               // a power of two
    parameter int PORTS = 1,
    parameter int LATENCY = 2,
    parameter int SECOND_LATENCY = 1,
    parameter int SLOT_BITS = 5,
    // Bits of a lane's object mask in the image: R^3, or what the scene's largest index needs.
    parameter int MASK_BITS = ENTRIES > 1 ? $clog2(ENTRIES) : ENTRIES > 0 ? 1 : R * R * R,
    parameter bit CACHED = 1'b0,           // rows come with the node, from table_fetch
    // Follow from these:
    localparam int CELLS = R * R * R,
    localparam int KEY_BITS = DESIGN == `CTU_DESIGN_COMPARATORS ? CELLS : 31,
    localparam int INDEX_BITS = ENTRIES > 1 ? $clog2(ENTRIES) : 1,
    localparam bit BIT_ROWS = `CTU_BIT_ROWS(DESIGN, ENTRIES),
    localparam int ROW_WIDTH = `CTU_ROW_WIDTH(DESIGN, R, ENTRIES),
    localparam int LOAD_BITS = `CTU_LOAD_BITS(DESIGN, R, ENTRIES),
    localparam int FETCHED_NEEDED = `CTU_FETCHED_BITS(DESIGN, R, ENTRIES, ROWS),
    localparam int FETCHED_BITS = CACHED && FETCHED_NEEDED > 0 ? FETCHED_NEEDED : 1
) (
    input  logic                                   clk_i,
    input  logic                                   rst_i,
    // link located: the lanes hit and asked
    input  logic                                   located_valid_i,
    input  logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] located_data_i,
    output logic                                   located_pop_o,
    // link survivors
    input  logic                                   survivors_ready_i,
    output logic                                   survivors_push_o,
    output logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] survivors_data_o,
    // keys {uncertain, end, begin}, or of comparators the cells touched; the first lane lowest
    output logic [                  SLOT_BITS-1:0] key_slot_o,
    input  logic [                 4*KEY_BITS-1:0] key_i,
    // object masks or indices; the first lane lowest
    output logic [                  SLOT_BITS-1:0] mask_slot_o,
    input  logic [                4*MASK_BITS-1:0] mask_i,
    // with CACHED: what table_fetch has brought for the node; the first lane lowest
    output logic [                  SLOT_BITS-1:0] row_slot_o,
    input  logic [             4*FETCHED_BITS-1:0] row_i,
    // without: the tables
    input  logic                                   load_valid_i,
    input  logic [                            1:0] load_table_i,
    input  logic [                           27:0] load_row_i,
    input  logic [                  LOAD_BITS-1:0] load_data_i,
    // a lane asks for a row that was left out (reachable), which ends the model's run; with located_pop_o
    output logic                                   left_out_o,
    output logic [                            3:0] activity_o
);
  localparam bit IS_PROJECTION = DESIGN == `CTU_DESIGN_PROJECTION;
  localparam bit HAS_LUT = `CTU_READS_LUT(DESIGN, ENTRIES);
  localparam bit MIRRORS = `CTU_ROWS_MIRROR(DESIGN, ENTRIES, ROWS);
  localparam int ID_MIRROR_BITS = `CTU_ID_MIRROR_BITS(DESIGN, ENTRIES, ROWS);
  localparam int ROWS_OF_LANE = `CTU_ROWS_OF_LANE(DESIGN);
  localparam bit IS_DEDUP = DESIGN == `CTU_DESIGN_DEDUP;
  localparam bit IS_KEYED = DESIGN != `CTU_DESIGN_COMPARATORS;
  // Memories that keys read; each is read by KEY_READS rows of a lane.
  localparam int KEY_TABLES = !IS_KEYED ? 0 : IS_PROJECTION ? PROJECTION_TABLES : 1;
  localparam int READS_OF_LANE = IS_KEYED ? ROWS_OF_LANE / KEY_TABLES : 1;
  localparam int LUT_TABLE = KEY_TABLES;
  localparam int AXES = IS_PROJECTION ? 2 : 3;
  localparam int TABLE_ROWS = `CTU_KEY_ROWS(DESIGN, R_RAY, ENTRIES, ROWS);
  localparam int MIRROR_BITS = AXES * ROWS_OF_LANE;  // of a lane
  localparam int ROW_BITS = $clog2(TABLE_ROWS);
  localparam int ID_BITS = DISTINCT > 1 ? $clog2(DISTINCT) : 1;
  localparam int TABLE_WIDTH = IS_DEDUP ? ID_BITS + ID_MIRROR_BITS : ROW_WIDTH;
  // What a lane's test sees.
  localparam int LANE_BITS = CACHED && BIT_ROWS ? 8 : ROW_WIDTH * ROWS_OF_LANE;
  localparam int OBJECT_BITS = !BIT_ROWS ? CELLS : CACHED ? 3 : INDEX_BITS;

  // The token that enters.
  logic [SLOT_BITS-1:0] slot;
  logic [3:0] hits, asked, uncertain, left_out, reads;
  logic enter, can_enter, enable, empty;
  assign slot = located_data_i[`CTU_NODE_FIELDS+:SLOT_BITS];
  assign hits = located_data_i[19:16];
  assign asked = located_data_i[3:0];
  assign reads = asked & ~uncertain;
  assign enter = located_valid_i && can_enter;
  assign located_pop_o = enter;
  assign left_out_o = enter && (reads & left_out) != 4'd0;
  wire unused_fields = &{1'b0, located_data_i[15:4]};

  // What travels with its reads, and stands beside the rows when they are there: {how rows are mirrored, slot, hits,
  // lanes with a question}.
  localparam int INFO_BITS = 4 * MIRROR_BITS + SLOT_BITS + 8;
  logic [4*MIRROR_BITS-1:0] mirror;
  logic [INFO_BITS-1:0] info_q, tested;
  always_ff @(posedge clk_i) if (enter) info_q <= {mirror, slot, hits, reads};
  wire [SLOT_BITS-1:0] tested_slot = tested[8+:SLOT_BITS];
  wire [4*MIRROR_BITS-1:0] tested_mirror = tested[8+SLOT_BITS+:4*MIRROR_BITS];

  // Reads by key.
  logic [4*(KEY_TABLES+1)-1:0] turns_of;  // by table; the compression LUT's last
  logic [3:0] turns;
  logic [4*TABLE_WIDTH*ROWS_OF_LANE-1:0] key_rows;  // by lane
  always_comb begin
    turns = 4'd1;
    for (int table_number = 0; table_number <= KEY_TABLES; table_number++)
      if (turns_of[4*table_number+:4] > turns) turns = turns_of[4*table_number+:4];
  end
  generate
    if (IS_KEYED) begin : g_keyed
      logic [4*ROWS_OF_LANE*ROW_BITS-1:0] row;
      for (genvar lane = 0; lane < 4; lane++) begin : g_lane
        assign uncertain[lane] = key_i[31*lane+30];
        lane_rows #(
            .DESIGN(DESIGN),
            .R_RAY(R_RAY),
            .ENTRIES(ENTRIES),
            .ROWS(ROWS)
        ) rows_of_key (
            .key_i(key_i[31*lane+:30]),
            .row_o(row[ROW_BITS*ROWS_OF_LANE*lane+:ROW_BITS*ROWS_OF_LANE]),
            .mirrored_o(mirror[MIRROR_BITS*lane+:MIRROR_BITS]),
            .left_out_o(left_out[lane])
        );
      end
      if (CACHED) begin : g_fetched
        assign key_rows = '0;
        assign turns_of[4*KEY_TABLES-1:0] = {KEY_TABLES{4'd1}};
        wire unused_row = &{1'b0, row};
      end else begin : g_tables
        for (genvar t = 0; t < KEY_TABLES; t++) begin : g_table
          // Read i of a table is row i mod READS_OF_LANE, from t on, of lane i / READS_OF_LANE.
          localparam int READS = 4 * READS_OF_LANE;
          logic [READS-1:0] valid;
          logic [READS*ROW_BITS-1:0] table_row;
          logic [READS*TABLE_WIDTH-1:0] data;
          for (genvar i = 0; i < READS; i++) begin : g_read
            localparam int LANE = i / READS_OF_LANE;
            localparam int ROW = ROWS_OF_LANE * LANE + t + i % READS_OF_LANE;
            assign valid[i] = reads[LANE];
            assign table_row[ROW_BITS*i+:ROW_BITS] = row[ROW_BITS*ROW+:ROW_BITS];
            assign key_rows[TABLE_WIDTH*ROW+:TABLE_WIDTH] = data[TABLE_WIDTH*i+:TABLE_WIDTH];
          end
          table_memory #(
              .ROWS(TABLE_ROWS),
              .WIDTH(TABLE_WIDTH),
              .READS(READS),
              .BANKS(BANKS),
              .PORTS(PORTS)
          ) memory (
              .clk_i,
              .rst_i,
              .enable_i(enable),
              .load_valid_i(load_valid_i && load_table_i == 2'(t)),
              .load_row_i(load_row_i[ROW_BITS-1:0]),
              .load_data_i(load_data_i[TABLE_WIDTH-1:0]),
              .start_i(enter),
              .valid_i(valid),
              .row_i(table_row),
              .turns_o(turns_of[4*t+:4]),
              .data_o(data)
          );
        end
      end
      assign key_slot_o = slot;
    end else begin : g_cells
      assign uncertain = 4'd0;
      assign left_out = 4'd0;
      assign mirror = '0;
      assign key_rows = key_i;
      assign key_slot_o = tested_slot;
    end
  endgenerate

  // Object masks, from the compression LUT where they are compressed.
  logic [4*OBJECT_BITS-1:0] objects;
  logic [4*INDEX_BITS-1:0] index;
  generate
    for (genvar lane = 0; lane < 4; lane++) begin : g_index
      assign index[INDEX_BITS*lane+:INDEX_BITS] = INDEX_BITS'(mask_i[MASK_BITS*lane+:MASK_BITS]);
    end
    if (HAS_LUT && CACHED) begin : g_fetched_lut
      for (genvar lane = 0; lane < 4; lane++) begin : g_object
        assign objects[CELLS*lane+:CELLS] = row_i[FETCHED_BITS*(lane+1)-CELLS+:CELLS];
      end
      assign turns_of[4*KEY_TABLES+:4] = 4'd1;
      assign mask_slot_o = tested_slot;
    end else if (HAS_LUT) begin : g_lut
      table_memory #(
          .ROWS(ENTRIES),
          .WIDTH(CELLS),
          .READS(4),
          .BANKS(BANKS),
          .PORTS(PORTS)
      ) memory (
          .clk_i,
          .rst_i,
          .enable_i(enable),
          .load_valid_i(load_valid_i && load_table_i == 2'(LUT_TABLE)),
          .load_row_i(load_row_i[INDEX_BITS-1:0]),
          .load_data_i(load_data_i[CELLS-1:0]),
          .start_i(enter),
          .valid_i(reads),
          .row_i(index),
          .turns_o(turns_of[4*KEY_TABLES+:4]),
          .data_o(objects)
      );
      assign mask_slot_o = slot;
    end else begin : g_no_lut
      for (genvar lane = 0; lane < 4; lane++) begin : g_object
        if (BIT_ROWS) begin : g_bit
          assign objects[OBJECT_BITS*lane+:OBJECT_BITS] = OBJECT_BITS'(index[INDEX_BITS*lane+:INDEX_BITS]);
        end else begin : g_mask
          assign objects[OBJECT_BITS*lane+:OBJECT_BITS] = mask_i[MASK_BITS*lane+:OBJECT_BITS];
        end
      end
      assign turns_of[4*KEY_TABLES+:4] = 4'd1;
      assign mask_slot_o = tested_slot;
    end
  endgenerate
  wire unused_tables = &{1'b0, load_valid_i, load_table_i, load_row_i, load_data_i, mask_i, index, row_i};
  assign row_slot_o = tested_slot;

  // The pipeline, and what of the rows a lane's test sees.
  logic [4*LANE_BITS-1:0] rows;
  logic exit;
  generate
    if (IS_DEDUP && !CACHED) begin : g_twice
      // First the ids, then what they number.
      logic [3:0] rest_q;  // turns that the ids still take, this one's included
      logic there_q;  // they stand in the first memory's register
      logic start, rows_can_enter, last_turn, rows_empty;
      logic [3:0] turns_by_id;
      logic [INFO_BITS-1:0] info_by_id_q;
      assign start = there_q && enable;
      assign can_enter = enable && rest_q == 4'd0 && (last_turn || (rows_can_enter && !there_q));
      assign empty = rest_q == 4'd0 && !there_q && rows_empty;
      assign tested = info_by_id_q;
      always_ff @(posedge clk_i) begin
        if (rst_i) begin
          rest_q <= 4'd0;
          there_q <= 1'b0;
        end else if (enable) begin
          rest_q <= enter ? turns - 4'd1 : rest_q == 4'd0 ? 4'd0 : rest_q - 4'd1;
          there_q <= rest_q == 4'd1 || (enter && turns == 4'd1);
        end
      end
      // A folded key's row is a mask mirrored, and what it numbers is mirrored too.
      logic [4*ID_BITS-1:0] id;
      logic [INFO_BITS-1:0] info_by_id;
      for (genvar lane = 0; lane < 4; lane++) begin : g_id
        assign id[ID_BITS*lane+:ID_BITS] = key_rows[TABLE_WIDTH*lane+ID_MIRROR_BITS+:ID_BITS];
        if (MIRRORS) begin : g_mirrored
`ifdef CTU_MUTATE_ID_NOT_MIRRORED
          assign info_by_id[8+SLOT_BITS+3*lane+:3] = info_q[8+SLOT_BITS+3*lane+:3];
`else
          assign info_by_id[8+SLOT_BITS+3*lane+:3] =
              info_q[8+SLOT_BITS+3*lane+:3] ^ key_rows[TABLE_WIDTH*lane+:3];
`endif
        end else begin : g_as_it_is
          assign info_by_id[8+SLOT_BITS+3*lane+:3] = 3'd0;
        end
      end
      assign info_by_id[8+SLOT_BITS-1:0] = info_q[8+SLOT_BITS-1:0];
      always_ff @(posedge clk_i) if (start) info_by_id_q <= info_by_id;
      wire unused_mirror = &{1'b0, info_q};
      table_memory #(
          .ROWS(DISTINCT),
          .WIDTH(ROW_WIDTH),
          .READS(4),
          .BANKS(BANKS),
          .PORTS(PORTS)
      ) memory (
          .clk_i,
          .rst_i,
          .enable_i(enable),
          .load_valid_i(load_valid_i && load_table_i == 2'd1),
          .load_row_i(load_row_i[ID_BITS-1:0]),
          .load_data_i(load_data_i[ROW_WIDTH-1:0]),
          .start_i(start),
          .valid_i(info_q[3:0]),
          .row_i(id),
          .turns_o(turns_by_id),
          .data_o(rows)
      );
      logic unused_exit_valid;
      pipe_control #(
          .LATENCY(LATENCY + SECOND_LATENCY - 1),
          .OCCUPIES_BITS(4)
      ) control (
          .clk_i,
          .rst_i,
          .enter_i(start),
`ifdef CTU_MUTATE_SECOND_TURNS_FORGOTTEN
          .occupies_i(4'd1),
`else
          .occupies_i(turns_by_id),
`endif
          .ready_i(survivors_ready_i),
          .can_enter_o(rows_can_enter),
          .start_o(last_turn),
          .enable_o(enable),
          .exit_valid_o(unused_exit_valid),
          .exit_o(exit),
          .empty_o(rows_empty)
      );
    end else begin : g_once
      logic unused_exit_valid, unused_start;
      if (CACHED && IS_KEYED) begin : g_fetched
        for (genvar lane = 0; lane < 4; lane++) begin : g_lane
          assign rows[LANE_BITS*lane+:LANE_BITS] = row_i[FETCHED_BITS*lane+ID_MIRROR_BITS+:LANE_BITS];
        end
        wire unused_key_rows = &{1'b0, key_rows};
      end else begin : g_read
        assign rows = key_rows;
      end
      if (CACHED && ID_MIRROR_BITS > 0) begin : g_mirrored
        for (genvar lane = 0; lane < 4; lane++) begin : g_lane
          assign tested[8+SLOT_BITS+3*lane+:3] = info_q[8+SLOT_BITS+3*lane+:3] ^ row_i[FETCHED_BITS*lane+:3];
        end
        assign tested[8+SLOT_BITS-1:0] = info_q[8+SLOT_BITS-1:0];
      end else begin : g_as_it_is
        assign tested = info_q;
      end
      pipe_control #(
          .LATENCY(LATENCY),
          .OCCUPIES_BITS(4)
      ) control (
          .clk_i,
          .rst_i,
          .enter_i(enter),
          .occupies_i(turns),
          .ready_i(survivors_ready_i),
          .can_enter_o(can_enter),
          .start_o(unused_start),
          .enable_o(enable),
          .exit_valid_o(unused_exit_valid),
          .exit_o(exit),
          .empty_o(empty)
      );
    end
  endgenerate

  // The tests, and the answer's way through what is left of the pipeline.
  logic [3:0] pass, tested_hits, survivors;
  generate
    for (genvar lane = 0; lane < 4; lane++) begin : g_test
      mask_lane #(
          .DESIGN(DESIGN),
          .R(R),
          .BIT_ROWS(BIT_ROWS),
          .MIRRORS(MIRRORS),
          .MIRROR_BITS(MIRROR_BITS),
          .ROW_BITS(LANE_BITS),
          .OBJECT_BITS(OBJECT_BITS)
      ) test (
          .row_i(rows[LANE_BITS*lane+:LANE_BITS]),
          .mirror_i(tested_mirror[MIRROR_BITS*lane+:MIRROR_BITS]),
          .object_i(objects[OBJECT_BITS*lane+:OBJECT_BITS]),
          .pass_o(pass[lane])
      );
    end
  endgenerate
  assign tested_hits = tested[7:4];
  assign survivors = tested_hits & (pass | ~tested[3:0]);

  logic [SLOT_BITS-1:0] slot_out;
  logic [3:0] hits_out, survivors_out;
  pipe_row #(
      .WIDTH(SLOT_BITS + 8),
      .DEPTH(IS_DEDUP && !CACHED ? LATENCY + SECOND_LATENCY - 2 : LATENCY - 1)
  ) row_answer (
      .clk_i,
      .enable_i(enable),
      .data_i({tested_slot, tested_hits, survivors}),
      .data_o({slot_out, hits_out, survivors_out})
  );
  assign survivors_push_o = exit;
  assign survivors_data_o = {slot_out, hits_out, survivors_out, 12'd0};

  always_comb begin
    if (!enable) activity_o = `CTU_OUTPUT_FULL;
    else if (!can_enter) activity_o = `CTU_BANK_CONFLICT;
    else if (enter || !empty) activity_o = `CTU_BUSY;
    else activity_o = `CTU_IDLE;
  end
endmodule
