// traversal_stack: the short stack of every context, on chip, spilled to memory exactly, never dropped.
//
//   in   sorted     surviving children of a node, nearest first
//   in   leaf_done  rays whose leaf is finished
//   in   refills    lines with spilled entries that have come back
//   in   starts     with PACKETS: rays that begin with the entries of their packet
//   out  to_scheduler  rays with their next reference
//   out  to_result     rays whose stack is empty, or that are finished
//   out  spills        writes of the oldest entries, reads of the youngest spilled ones
//   out  released      with PACKETS: packets whose last ray has begun
//   latency a token taken in cycle t is worked on from t + 1: pushes push_width_i entries a cycle, in the last one the
//           ray goes on to the scheduler, or pops an entry a cycle; in its last cycle the next token is taken
//   twin    model/pipeline/traversal_stack.h; the order of t0 and best hit as ExecSource::drops
//   stated  docs/unit.md
//
// On chip a context has a ring of MAX_ENTRIES places, one or several rows of as many banks as a line holds entries:
// entry p lies at place p mod MAX_ENTRIES, in memory at byte 8 p of the context's region: reference, then t0; with EXITS at byte 16 p, and t1 behind. A
// request's address is that of its batch's first entry; the line of a write holds the batch at its place, and memory
// takes the bytes of spill_batch_i entries from the address on and leaves the others as they are. A read gets the whole line.
// As all sizes are powers of two no batch crosses a line or a row, and entries keep their place between line and row,
// so nothing is shifted, and a cycle reads one row: for the top, or for the batch that is written.
//
// A context begins empty, and is left empty when its ray goes to the result, so nobody needs to clear it. Without
// HAS_SPILLS no ray may ever hold more than entries_i, and the three memory ports are dead.
//
// A ray that begins is a push whose survivors are the entries of its packet; the nearest of them goes to the scheduler, or
// is dropped as one that is popped, which makes it a pop.
`include "tokens.svh"

module traversal_stack #(
    parameter int SLOT_BITS = 2,
    parameter int MAX_ENTRIES = 16,  // of a context on chip; a power of two from 4 to 64
    parameter int DEPTH_BITS = 8,    // fewer than 1 << DEPTH_BITS entries of a ray, spilled ones included; at least 7
    parameter int ADDRESS_BITS = 32,
    parameter int LINE_BYTES = 128,
    parameter bit HAS_SPILLS = 1'b1,
    parameter bit EXITS = 1'b0,      // entries hold t1 too, for primitive_cull
    parameter int PACKETS = 0,       // under way at once, at most; 0: rays begin alone
    parameter int PACKET_ENTRIES = 1,
    localparam int PACKET_BITS = PACKETS <= 2 ? 1 : $clog2(PACKETS),
    localparam int NUMBER_BITS = PACKETS == 0 ? 2 : 4  // of survivors, or entries of a packet
) (
    input logic clk_i,
    input logic rst_i,

    // Straps.
    input logic [             6:0] entries_i,       // 1 .. MAX_ENTRIES
    input logic [             1:0] push_width_i,    // 1 .. 3
    input logic [             6:0] spill_batch_i,   // a power of two, <= entries_i and <= entries of a line
    input logic [ADDRESS_BITS-1:0] spill_base_i,
    input logic [ADDRESS_BITS-1:0] spill_region_i,  // bytes of a context, whole lines

    input  logic                                  sorted_valid_i,
    input  logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] sorted_data_i,
    output logic                                  sorted_pop_o,
    input  logic                                  leaf_done_valid_i,
    input  logic [                   SLOT_BITS:0] leaf_done_data_i,
    output logic                                  leaf_done_pop_o,
    input  logic                                  refills_valid_i,
    input  logic [ `CTU_ID_BITS+8*LINE_BYTES-1:0] refills_data_i,
    output logic                                  refills_pop_o,

    input  logic                                              to_scheduler_ready_i,
    output logic                                              to_scheduler_push_o,
    output logic [                          SLOT_BITS+32-1:0] to_scheduler_data_o,
    input  logic                                              to_result_ready_i,
    output logic                                              to_result_push_o,
    output logic [                             SLOT_BITS-1:0] to_result_data_o,
    input  logic                                              spills_ready_i,
    output logic                                              spills_push_o,
    output logic [ADDRESS_BITS+`CTU_ID_BITS+8*LINE_BYTES : 0] spills_data_o,

    // With PACKETS.
    input  logic                             starts_valid_i,
    input  logic [SLOT_BITS+PACKET_BITS : 0] starts_data_i,      // {slot, packet, last}
    output logic                             starts_pop_o,
    input  logic                             released_ready_i,
    output logic                             released_push_o,
    output logic [          PACKET_BITS-1:0] released_data_o,
    // How many entries the packet in starts has; and those {t0, reference} of the packet whose ray begins.
    input  logic [                      4:0] packet_count_i,
    output logic [          PACKET_BITS-1:0] packet_o,
    input  logic [    64*PACKET_ENTRIES-1:0] packet_entries_i,

    // Registers of the context that is served, and the node it has visited.
    output logic [SLOT_BITS-1:0] slot_o,
    input  logic [        127:0] children_i,
    input  logic [        127:0] t0_i,
    input  logic [        127:0] t1_i,        // with EXITS
    input  logic [         31:0] best_t_i,

    // A node's visit is done.
    output logic                 visit_valid_o,
    output logic [SLOT_BITS-1:0] visit_slot_o,

    // With EXITS: the ray's stay in the box that it goes to.
    output logic [31:0] stay_begin_o,
    output logic [31:0] stay_end_o,

    output logic [3:0] activity_o
);
  localparam int SLOTS = 1 << SLOT_BITS;
  localparam int ENTRY = EXITS ? 96 : 64;    // bits on chip: t1, t0, reference
  localparam int STRIDE = EXITS ? 128 : 64;  // in memory
  localparam int LINE_ENTRIES = 8 * LINE_BYTES / STRIDE;
  localparam int BANKS = !HAS_SPILLS ? 4 : LINE_ENTRIES < MAX_ENTRIES ? LINE_ENTRIES : MAX_ENTRIES;
  localparam int BANK_BITS = $clog2(BANKS);
  localparam int PLACE_BITS = $clog2(MAX_ENTRIES);
  localparam int ROW_BITS = SLOT_BITS + PLACE_BITS - BANK_BITS;  // of a row's number

  localparam logic [1:0] JOB_NONE = 2'd0;
  localparam logic [1:0] JOB_PUSH = 2'd1;
  localparam logic [1:0] JOB_POP = 2'd2;
  localparam logic [1:0] JOB_FINISH = 2'd3;

  // The ray that is served: survivors number 1 .. to_push_q are still to be pushed.
  logic [1:0] job_q;
  logic [NUMBER_BITS-1:0] to_push_q;
  logic [SLOT_BITS-1:0] slot_q;
  logic [7:0] order_q;
  logic [DEPTH_BITS-1:0] depth_q, spilled_q;
  assign slot_o = slot_q;

  // A row of its entries, bank 0 lowest: t0 above the reference, t1 above that.
  logic [ENTRY*BANKS-1:0] row;
  wire [PLACE_BITS-1:0] top_place = depth_q[PLACE_BITS-1:0] - PLACE_BITS'(1);
  wire [PLACE_BITS-1:0] read_place = job_q == JOB_PUSH ? spilled_q[PLACE_BITS-1:0] : top_place;
  wire [ROW_BITS-1:0] read_row = ROW_BITS'({slot_q, read_place} >> BANK_BITS);
  wire [BANK_BITS-1:0] top_bank = top_place[BANK_BITS-1:0];
  wire [ENTRY-1:0] top = row[ENTRY*32'(top_bank)+:ENTRY];

  // The ray begins: it is a packet's, of which no entry is there, which it is the last one of.
  logic begins, begins_none, begins_last;
  logic [63:0] first_entry;
  logic [64*(1<<NUMBER_BITS)-1:0] packet_entries;
  wire [31:0] compared_t0 = begins ? first_entry[63:32] : top[63:32];
  wire released_ready = !begins_last || released_ready_i;

  logic beyond, at_best, unused_unordered;
  float_compare compare_top (
      .a_i(compared_t0),
      .b_i(best_t_i),
      .less_o(beyond),
      .equal_o(at_best),
      .unordered_o(unused_unordered)
  );
  wire dropping = !(beyond || at_best);

  // Work of this cycle.
  wire [DEPTH_BITS-1:0] room = DEPTH_BITS'(entries_i) - (depth_q - spilled_q);
  wire [1:0] wanted = to_push_q < NUMBER_BITS'(push_width_i) ? to_push_q[1:0] : push_width_i;
  wire [1:0] fitting = room < DEPTH_BITS'(wanted) ? room[1:0] : wanted;
  logic spills, refills, pushes, pops, passes, finishes, drops, begun, ends;
  logic [1:0] pushed;
  logic [3:0] work;
  always_comb begin
    spills = 1'b0;    // a batch is written
    refills = 1'b0;   // a batch is read
    pushes = 1'b0;    // `pushed` entries are pushed
    pops = 1'b0;      // an entry is popped
    passes = 1'b0;    // the ray goes to the scheduler
    finishes = 1'b0;  // the ray goes to the result
    drops = 1'b0;     // a ray that begins drops its nearest entry
    begun = 1'b0;     // a ray that begins has done so
    pushed = 2'd0;
    work = `CTU_BUSY;
    case (job_q)
      JOB_NONE: work = `CTU_IDLE;
      JOB_PUSH:
      if (HAS_SPILLS && to_push_q != '0 && room == '0) begin
        spills = spills_ready_i;
        if (!spills_ready_i) work = `CTU_SPILL;
      end else begin
        pushes = 1'b1;
        pushed = HAS_SPILLS ? fitting : wanted;
        if (begins && NUMBER_BITS'(pushed) == to_push_q) begin
          finishes = begins_none && released_ready && to_result_ready_i;
          drops = !begins_none && dropping && released_ready;
          passes = !begins_none && !dropping && released_ready && to_scheduler_ready_i;
          begun = finishes || drops || passes;
          if (!begun && pushed == 2'd0) work = `CTU_OUTPUT_FULL;
        end else if (NUMBER_BITS'(pushed) == to_push_q) begin
          passes = to_scheduler_ready_i;
          if (!to_scheduler_ready_i && pushed == 2'd0) work = `CTU_OUTPUT_FULL;
        end
      end
      default:
      if (job_q == JOB_FINISH || depth_q == '0) begin
        finishes = to_result_ready_i;
        if (!to_result_ready_i) work = `CTU_OUTPUT_FULL;
      end else if (HAS_SPILLS && depth_q == spilled_q) begin
        refills = spills_ready_i;
        if (!spills_ready_i) work = `CTU_SPILL;
      end else begin
        passes = !dropping && to_scheduler_ready_i;
        pops = dropping || to_scheduler_ready_i;
        if (!pops) work = `CTU_OUTPUT_FULL;
      end
    endcase
    ends = passes || finishes || refills;
  end
  wire [NUMBER_BITS-1:0] to_push = to_push_q - NUMBER_BITS'(pushed);
  wire [DEPTH_BITS-1:0] depth = depth_q + DEPTH_BITS'(pushed) - DEPTH_BITS'(pops);
  wire [DEPTH_BITS-1:0] spilled = spilled_q + (spills ? DEPTH_BITS'(spill_batch_i) : '0);
`ifdef CTU_MUTATE_KEPT_DEPTH
  wire occupied = depth != '0;
`else
  wire occupied = depth != '0 && !finishes;
`endif

  wire [1:0] nearest = order_q[1:0];
  assign to_scheduler_push_o = passes;
  wire [31:0] nearest_child = begins ? first_entry[31:0] : children_i[32*32'(nearest)+:32];
  assign to_scheduler_data_o = {slot_q, job_q == JOB_PUSH ? nearest_child : top[31:0]};
  generate
    if (EXITS) begin : g_stay
      assign stay_begin_o = job_q == JOB_PUSH ? t0_i[32*32'(nearest)+:32] : top[63:32];
      assign stay_end_o = job_q == JOB_PUSH ? t1_i[32*32'(nearest)+:32] : top[ENTRY-1-:32];
    end else begin : g_no_stay
      assign stay_begin_o = 32'd0;
      assign stay_end_o = 32'd0;
      wire unused_t1 = &{1'b0, t1_i};
    end
  endgenerate
  assign to_result_push_o = finishes;
  assign to_result_data_o = slot_q;

  // The next token: inputs take turns.
  wire [3:0] waiting = {PACKETS != 0 && starts_valid_i, HAS_SPILLS && refills_valid_i, leaf_done_valid_i, sorted_valid_i};
  logic [1:0] turn_q, chosen, turn;
  generate
    if (PACKETS != 0) begin : g_four_inputs
      always_comb begin
        case (turn_q)
          2'd0: chosen = waiting[0] ? 2'd0 : waiting[1] ? 2'd1 : waiting[2] ? 2'd2 : 2'd3;
          2'd1: chosen = waiting[1] ? 2'd1 : waiting[2] ? 2'd2 : waiting[3] ? 2'd3 : 2'd0;
          2'd2: chosen = waiting[2] ? 2'd2 : waiting[3] ? 2'd3 : waiting[0] ? 2'd0 : 2'd1;
          default: chosen = waiting[3] ? 2'd3 : waiting[0] ? 2'd0 : waiting[1] ? 2'd1 : 2'd2;
        endcase
        turn = chosen + 2'd1;
      end
    end else begin : g_three_inputs
      always_comb begin
        case (turn_q)
          2'd0: chosen = waiting[0] ? 2'd0 : waiting[1] ? 2'd1 : 2'd2;
          2'd1: chosen = waiting[1] ? 2'd1 : waiting[2] ? 2'd2 : 2'd0;
          default: chosen = waiting[2] ? 2'd2 : waiting[0] ? 2'd0 : 2'd1;
        endcase
        turn = chosen == 2'd2 ? 2'd0 : chosen + 2'd1;
      end
    end
  endgenerate
  wire takes = (job_q == JOB_NONE || ends) && waiting != 4'd0;
  assign sorted_pop_o = takes && chosen == 2'd0;
  assign leaf_done_pop_o = takes && chosen == 2'd1;
  assign refills_pop_o = takes && chosen == 2'd2;
  assign starts_pop_o = PACKETS != 0 && takes && chosen == 2'd3;
  assign activity_o = takes ? `CTU_BUSY : work;

  wire [SLOT_BITS-1:0] sorted_slot = sorted_data_i[`CTU_NODE_FIELDS+:SLOT_BITS];
  wire [3:0] survivors = sorted_data_i[15:12];
  wire unused_sorted = &{1'b0, sorted_data_i[19:16], sorted_data_i[3:0]};
  wire [SLOT_BITS-1:0] refill_slot = refills_data_i[8*LINE_BYTES+:SLOT_BITS];
  wire unused_refills = &{1'b0, refills_data_i};
  wire [SLOT_BITS-1:0] starts_slot = starts_data_i[PACKET_BITS+1+:SLOT_BITS];
  wire [SLOT_BITS-1:0] next_slot = PACKETS != 0 && chosen == 2'd3 ? starts_slot : chosen == 2'd0 ? sorted_slot :
                                   chosen == 2'd1 ? leaf_done_data_i[1+:SLOT_BITS] : refill_slot;
  assign visit_valid_o = sorted_pop_o;
  assign visit_slot_o = sorted_slot;

  // Entries of each context while another one is served. No ray comes back in the cycle in which it leaves.
  logic [DEPTH_BITS-1:0] depths_q[SLOTS], spilleds_q[SLOTS];
  logic [SLOTS-1:0] occupied_q;
  wire [DEPTH_BITS-1:0] next_depth = occupied_q[next_slot] ? depths_q[next_slot] : '0;
  wire [DEPTH_BITS-1:0] next_spilled = occupied_q[next_slot] ? spilleds_q[next_slot] : '0;
  wire [DEPTH_BITS-1:0] refill_first = next_spilled - DEPTH_BITS'(spill_batch_i);
  always_ff @(posedge clk_i) begin
    if (ends) begin
      depths_q[slot_q] <= depth;
      spilleds_q[slot_q] <= spilled;
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      job_q <= JOB_NONE;
      turn_q <= 2'd0;
      occupied_q <= '0;
    end else begin
      if (ends) occupied_q[slot_q] <= occupied;
      if (takes) begin
`ifndef CTU_MUTATE_NO_TURNS
        turn_q <= turn;
`endif
        job_q <= starts_pop_o ? JOB_PUSH : sorted_pop_o ? (survivors == 4'd0 ? JOB_POP : JOB_PUSH) :
                 leaf_done_pop_o && leaf_done_data_i[0] ? JOB_FINISH : JOB_POP;
      end else if (ends) begin
        job_q <= JOB_NONE;
      end else if (drops) begin
        job_q <= JOB_POP;
      end
    end
  end

  wire [1:0] survivors_to_push =
      2'(survivors[0]) + 2'(survivors[1]) + 2'(survivors[2]) + 2'(survivors[3]) - 2'd1;
  logic [NUMBER_BITS-1:0] start_to_push;
  always_ff @(posedge clk_i) begin
    if (takes) begin
      slot_q <= next_slot;
      order_q <= sorted_data_i[11:4];
      to_push_q <= starts_pop_o ? start_to_push : NUMBER_BITS'(survivors_to_push);
      depth_q <= next_depth;
      spilled_q <= refills_pop_o ? refill_first : next_spilled;
    end else begin
      to_push_q <= to_push;
      depth_q <= depth;
      spilled_q <= spilled;
    end
  end

  // The ray that begins, and its packet.
  generate
    if (PACKETS != 0) begin : g_packets
      logic begins_q, none_q, last_q;
      logic [PACKET_BITS-1:0] packet_q;
      always_ff @(posedge clk_i) begin
        if (rst_i) begins_q <= 1'b0;
        else if (takes) begins_q <= starts_pop_o;
        else if (begun) begins_q <= 1'b0;
        if (takes) begin
          none_q <= packet_count_i == 5'd0;
          last_q <= starts_data_i[0];
          packet_q <= starts_data_i[PACKET_BITS:1];
        end
      end
      wire [4:0] farthest = packet_count_i - 5'd1;
      assign start_to_push = packet_count_i == 5'd0 ? '0 : farthest[NUMBER_BITS-1:0];
      wire unused_farthest = farthest[4];
      assign begins = begins_q;
      assign begins_none = none_q;
      assign begins_last = last_q;
      assign packet_o = packet_q;
      assign packet_entries = (64 * (1 << NUMBER_BITS))'(packet_entries_i);
      assign first_entry = packet_entries_i[63:0];
      assign released_push_o = begun && last_q;
      assign released_data_o = packet_q;
    end else begin : g_alone
      assign begins = 1'b0;
      assign begins_none = 1'b0;
      assign begins_last = 1'b0;
      assign packet_o = '0;
      assign packet_entries = '0;
      assign first_entry = '0;
      assign start_to_push = '0;
      assign released_push_o = 1'b0;
      assign released_data_o = '0;
      wire unused_packets =
          &{1'b0, starts_valid_i, starts_data_i, released_ready_i, packet_count_i, packet_entries_i, begun};
    end
  endgenerate

  // What is pushed in this cycle, farthest first.
  logic [3*ENTRY-1:0] pushed_entries;
  generate
    for (genvar place = 0; place < 3; place++) begin : g_pushed
`ifdef CTU_MUTATE_NEAREST_FIRST
      wire [NUMBER_BITS-1:0] number = NUMBER_BITS'(1) + NUMBER_BITS'(place);
`else
      wire [NUMBER_BITS-1:0] number = to_push_q - NUMBER_BITS'(place);
`endif
      wire [1:0] lane = order_q[2*32'(number[1:0])+:2];
      wire [ENTRY-1:0] survivor =
          ENTRY'({t1_i[32*32'(lane)+:32], t0_i[32*32'(lane)+:32], children_i[32*32'(lane)+:32]});
      assign pushed_entries[ENTRY*place+:ENTRY] = begins ? ENTRY'(packet_entries[64*32'(number)+:64]) : survivor;
    end
  endgenerate

  wire [ROW_BITS-1:0] refill_row = ROW_BITS'({refill_slot, refill_first[PLACE_BITS-1:0]} >> BANK_BITS);
  generate
    for (genvar bank = 0; bank < BANKS; bank++) begin : g_bank
      logic [ENTRY-1:0] entries_q[1 << ROW_BITS];
      assign row[ENTRY*bank+:ENTRY] = entries_q[read_row];

      // Which of the pushed ones comes here, if any.
      wire [BANK_BITS-1:0] which = BANK_BITS'(bank) - depth_q[BANK_BITS-1:0];
      wire is_pushed = pushes && which < BANK_BITS'(pushed);
      wire [1:0] pushed_which = which[1:0];
      wire [ENTRY-1:0] entry = pushed_entries[ENTRY*32'(pushed_which)+:ENTRY];
      wire [PLACE_BITS-1:0] place = depth_q[PLACE_BITS-1:0] + PLACE_BITS'(pushed_which);
      wire [ROW_BITS-1:0] pushed_row = ROW_BITS'({slot_q, place} >> BANK_BITS);
      if (HAS_SPILLS) begin : g_spills
        wire [BANK_BITS-1:0] refill_which = BANK_BITS'(bank) - refill_first[BANK_BITS-1:0];
        wire is_refilled = refills_pop_o && 7'(refill_which) < spill_batch_i;
        logic [ENTRY-1:0] refill;
        if (LINE_ENTRIES == BANKS) begin : g_one
          assign refill = refills_data_i[STRIDE*bank+:ENTRY];
        end else begin : g_choice
          localparam int PART_BITS = $clog2(LINE_ENTRIES / BANKS);
          wire [PART_BITS-1:0] part = refill_first[BANK_BITS+:PART_BITS];
          assign refill = refills_data_i[STRIDE*(BANKS*32'(part)+bank)+:ENTRY];
        end
        always_ff @(posedge clk_i) begin
          if (is_pushed) entries_q[pushed_row] <= entry;
          if (is_refilled) entries_q[refill_row] <= refill;
        end
      end else begin : g_no_spills
        wire unused_refill_row = &{1'b0, refill_row};
        always_ff @(posedge clk_i) if (is_pushed) entries_q[pushed_row] <= entry;
      end
    end
  endgenerate

  generate
    if (HAS_SPILLS) begin : g_requests
`ifdef CTU_MUTATE_REFILL_OLDEST
      wire [DEPTH_BITS-1:0] first = job_q == JOB_PUSH ? spilled_q : '0;
`else
      wire [DEPTH_BITS-1:0] first = job_q == JOB_PUSH ? spilled_q : spilled_q - DEPTH_BITS'(spill_batch_i);
`endif
      wire [ADDRESS_BITS-1:0] address =
          spill_base_i + ADDRESS_BITS'(slot_q) * spill_region_i + (ADDRESS_BITS'(first) << $clog2(STRIDE / 8));
      assign spills_push_o = spills || refills;
      logic [STRIDE*BANKS-1:0] written;
      for (genvar bank = 0; bank < BANKS; bank++) begin : g_written
        assign written[STRIDE*bank+:STRIDE] = STRIDE'(row[ENTRY*bank+:ENTRY]);
      end
      assign spills_data_o = {address, `CTU_ID_BITS'(slot_q), spills, {(LINE_ENTRIES / BANKS) {written}}};
    end else begin : g_no_requests
      assign spills_push_o = 1'b0;
      assign spills_data_o = '0;
      wire unused_spills = &{1'b0, spills_ready_i, refills_valid_i, spill_base_i, spill_region_i, entries_i};
    end
  endgenerate
endmodule
