// line_fetch: brings the lines that hold a node, a leaf or rows of tables; what node_fetch, leaf_fetch and table_fetch
// have in common. The module around it says which lines a token needs, and keeps tokens and bytes by context.
//
//   latency hits: ceil(lines / PORTS) + hit_latency; interval ceil(lines / PORTS), and 1 for each line that arrives
//   twin    LineFetch (model/pipeline/line_fetch.h)
//   stated  docs/unit.md
//
// Lookup: in a cycle with look_o, lines_i are the next lines of the context slot_o, all of them different; the lowest
// `count` set bits of looked_up_o say how many were looked up, and last_i which one ends the token. starts_o: it is the
// first cycle of a round, of the token at requests (requests_pop_o), or of one whose lines are now looked up again.
// Data: a hit of cycle t stands at hit_data_o in t + 1; a line from memory is in the link of fills, for all contexts of
// fill_waiters_o.
`include "tokens.svh"

module line_fetch #(
    parameter int SLOT_BITS = 1,
    parameter int ADDRESS_BITS = 32,
    parameter int LINE_BYTES = 32,
    parameter int PORTS = 1,            // lines looked up in a cycle
    parameter int MAX_SETS = 2,         // a power of two
    parameter int MAX_WAYS = 2,
    parameter int MAX_MSHRS = 4,
    parameter int MAX_HIT_LATENCY = 4,
    parameter int MAX_LINES = 6,        // of a round of a token
    parameter bit TWO_ROUNDS = 1'b0,
    localparam int SET_BITS = MAX_SETS == 1 ? 1 : $clog2(MAX_SETS),
    localparam int LINE_NUMBER_BITS = ADDRESS_BITS - $clog2(LINE_BYTES),
    localparam int SLOTS = 1 << SLOT_BITS
) (
    input logic clk_i,
    input logic rst_i,

    // Straps.
    input logic [                 SET_BITS-1:0] set_mask_i,     // sets in use - 1
    input logic [       $clog2(MAX_WAYS+1)-1:0] ways_i,         // in use; 0: no cache
    input logic [      $clog2(MAX_MSHRS+1)-1:0] mshrs_i,        // in use, at least 1
    input logic [$clog2(MAX_HIT_LATENCY+1)-1:0] hit_latency_i,  // at least 1
    input logic                                 two_rounds_i,   // tokens are looked up twice; only with TWO_ROUNDS

    // Links.
    input  logic                    requests_valid_i,
    input  logic [   SLOT_BITS-1:0] requests_slot_i,
    output logic                    requests_pop_o,
    input  logic                    fills_valid_i,
    input  logic [             7:0] fills_id_i,
    input  logic [8*LINE_BYTES-1:0] fills_line_i,
    output logic                    fills_pop_o,
    input  logic                    misses_ready_i,
    output logic                    misses_push_o,
    output logic [ADDRESS_BITS+8:0] misses_data_o,     // a request without data
    input  logic                    done_ready_i,
    output logic                    done_push_o,
    output logic [   SLOT_BITS-1:0] done_slot_o,
    output logic [             3:0] activity_o,

    // Lookup.
    output logic                              look_o,
    output logic                              starts_o,
    output logic                              second_o,     // it is the second round of the context
    output logic [             SLOT_BITS-1:0] slot_o,
    input  logic                              none_i,       // no line; may be set with starts_o only
    input  logic [PORTS*LINE_NUMBER_BITS-1:0] lines_i,
    input  logic [                 PORTS-1:0] last_i,
    output logic [                 PORTS-1:0] looked_up_o,

    // Data.
    output logic [             PORTS-1:0] hit_o,           // looked up and there
    output logic [PORTS*8*LINE_BYTES-1:0] hit_data_o,      // of the cycle before
    output logic [  LINE_NUMBER_BITS-1:0] fill_number_o,   // of the line in fills
    output logic [             SLOTS-1:0] fill_waiters_o   // 0 without fills_pop_o
);
  localparam int WAY_BITS = MAX_WAYS == 1 ? 1 : $clog2(MAX_WAYS);
  localparam int NUMBER_BITS = MAX_MSHRS == 1 ? 1 : $clog2(MAX_MSHRS);
  localparam int WAIT_BITS = $clog2(MAX_LINES + 2);  // the lines and the end of the data reads

  // What was begun in an earlier cycle.
  logic active_q;
  logic [SLOT_BITS-1:0] slot_q;
  logic again_valid;  // a token can start its second round
  logic [SLOT_BITS-1:0] again_slot;

  // A line that arrives takes the tags for its cycle.
  wire wanted = active_q || again_valid || requests_valid_i;
  assign fills_pop_o = fills_valid_i;
  assign look_o = wanted && !fills_valid_i;
  assign starts_o = look_o && !active_q;
`ifdef CTU_MUTATE_FETCH_SECOND_ROUND_LAST
  wire again = again_valid && !requests_valid_i;
`else
  wire again = again_valid;  // before new tokens
`endif
  assign requests_pop_o = starts_o && !again;
  assign slot_o = active_q ? slot_q : again ? again_slot : requests_slot_i;
  wire walks = look_o && !(starts_o && none_i);

  // The lines of the cycle, one after the other up to the first that cannot be looked up.
  logic [PORTS-1:0] in_cache, found, misses;
  logic full, last_register, none_in_use;
  logic [NUMBER_BITS-1:0] free_number;
  logic [LINE_NUMBER_BITS-1:0] miss_line;
  logic no_register, no_room, ends;
  logic [PORTS-1:0] asks;  // of memory
  always_comb begin : walk
    logic goes, asked;
    goes = walks;
    asked = 1'b0;
    no_register = 1'b0;
    no_room = 1'b0;
    ends = 1'b0;
    miss_line = '0;
    for (int p = 0; p < PORTS; p++) begin
      asks[p] = 1'b0;
      if (goes && !in_cache[p] && !found[p]) begin
        no_register = asked ? last_register : full;
`ifdef CTU_MUTATE_FETCH_TWO_REQUESTS
        no_room = !no_register && !misses_ready_i;
`else
        no_room = !no_register && (asked || !misses_ready_i);
`endif
        asks[p] = !no_register && !no_room;
        goes = asks[p];
      end
      looked_up_o[p] = goes;
      if (asks[p]) begin
        asked = 1'b1;
        miss_line = lines_i[LINE_NUMBER_BITS*p+:LINE_NUMBER_BITS];
      end
      ends = ends || (goes && last_i[p]);
      goes = goes && !last_i[p];
    end
  end
  assign hit_o = looked_up_o & in_cache;
  assign misses = looked_up_o & ~in_cache;
  assign misses_push_o = asks != '0;
  assign misses_data_o = {miss_line, {$clog2(LINE_BYTES) {1'b0}}, 8'(free_number), 1'b0};

  logic [PORTS*SET_BITS-1:0] sets;
  logic [PORTS*WAY_BITS-1:0] ways;
  logic [SET_BITS-1:0] install_set;
  logic [WAY_BITS-1:0] install_way;
  logic [SLOTS-1:0] waiters;
  cache_tags #(
      .LINE_NUMBER_BITS(LINE_NUMBER_BITS),
      .PORTS(PORTS),
      .MAX_SETS(MAX_SETS),
      .MAX_WAYS(MAX_WAYS)
  ) tags (
      .clk_i,
      .rst_i,
      .set_mask_i,
      .ways_i,
      .lines_i,
      .hit_o(in_cache),
      .set_o(sets),
      .way_o(ways),
      .touch_i(looked_up_o),
      .install_i(fills_pop_o),
      .install_line_i(fill_number_o),
      .install_set_o(install_set),
      .install_way_o(install_way)
  );
  cache_data #(
      .LINE_BITS(8 * LINE_BYTES),
      .PORTS(PORTS),
      .SETS(MAX_SETS),
      .WAYS(MAX_WAYS)
  ) data (
      .clk_i,
      .set_i(sets),
      .way_i(ways),
      .read_i(hit_o),
      .data_o(hit_data_o),
      .write_i(fills_pop_o),
      .write_set_i(install_set),
      .write_way_i(install_way),
      .write_data_i(fills_line_i)
  );
  miss_registers #(
      .SLOT_BITS(SLOT_BITS),
      .LINE_NUMBER_BITS(LINE_NUMBER_BITS),
      .PORTS(PORTS),
      .MAX_MSHRS(MAX_MSHRS)
  ) registers (
      .clk_i,
      .rst_i,
      .mshrs_i,
      .lines_i,
      .found_o(found),
      .full_o(full),
      .last_o(last_register),
      .none_in_use_o(none_in_use),
      .free_o(free_number),
      .wait_i(misses),
      .wait_slot_i(slot_o),
      .allocate_i(misses_push_o),
      .allocate_line_i(miss_line),
      .release_i(fills_pop_o),
      .release_number_i(NUMBER_BITS'(fills_id_i)),
      .release_line_o(fill_number_o),
      .release_waiters_o(waiters)
  );
  assign fill_waiters_o = fills_pop_o ? waiters : '0;

  always_ff @(posedge clk_i) begin
    if (rst_i) active_q <= 1'b0;
    else if (look_o) active_q <= walks && !ends;
    if (starts_o) slot_q <= slot_o;
  end

  // Contexts whose lines have been looked up, until the end of their data reads; and when that is: bit i in i cycles.
  logic [MAX_HIT_LATENCY-1:0] reading_due_q;
  logic [SLOT_BITS-1:0] read_slot;
  logic unused_reading;
  wire read = reading_due_q[0];
  wire [MAX_HIT_LATENCY:0] read_ends = (MAX_HIT_LATENCY + 1)'(ends) << hit_latency_i;
  wire unused_bits = &{1'b0, fills_id_i, read_ends[0]};
  arrival_queue #(
      .SLOT_BITS(SLOT_BITS)
  ) reading (
      .clk_i,
      .rst_i,
      .first_push_i(ends),
      .first_slot_i(slot_o),
      .second_push_i(1'b0),
      .second_slot_i({SLOT_BITS{1'b0}}),
      .pop_i(read),
      .valid_o(unused_reading),
      .slot_o(read_slot)
  );
  always_ff @(posedge clk_i) begin
    if (rst_i) reading_due_q <= '0;
    else reading_due_q <= (reading_due_q >> 1) | read_ends[MAX_HIT_LATENCY:1];
  end

  // What each context waits for: lines from memory, and the end of its data reads. Both can come in one cycle.
  logic [WAIT_BITS-1:0] missed;
  always_comb begin
    missed = '0;
    for (int p = 0; p < PORTS; p++) missed = missed + WAIT_BITS'(misses[p]);
  end
  (* mem2reg *) logic [WAIT_BITS-1:0] waiting_q[SLOTS];
  logic [SLOTS-1:0] filled_up, read_up;  // contexts that wait for nothing more: by a line, by the end of reads
  generate
    for (genvar s = 0; s < SLOTS; s++) begin : g_waiting
      wire reads = read && 32'(read_slot) == s;
      wire looks = walks && 32'(slot_o) == s;
`ifdef CTU_MUTATE_FETCH_READS_UNCOUNTED
      assign filled_up[s] = fill_waiters_o[s] && waiting_q[s] <= WAIT_BITS'(2);
`else
      assign filled_up[s] = fill_waiters_o[s] && waiting_q[s] == WAIT_BITS'(1);
`endif
      assign read_up[s] = reads && waiting_q[s] == WAIT_BITS'(1) + WAIT_BITS'(fill_waiters_o[s]);
      always_ff @(posedge clk_i) begin
        if (looks) waiting_q[s] <= (starts_o ? WAIT_BITS'(1) : waiting_q[s]) + missed;
        else if (fill_waiters_o[s] || reads)
          waiting_q[s] <= waiting_q[s] - WAIT_BITS'(fill_waiters_o[s]) - WAIT_BITS'(reads);
      end
    end
  endgenerate

  // Second rounds start in the order in which the first ones ended: of one cycle first those that a line ended, by
  // number, then the one whose data reads did.
  logic [SLOTS-1:0] goes_again;  // among filled_up and read_up
  generate
    if (TWO_ROUNDS) begin : g_again
      logic [SLOTS-1:0] second_q, again_q;  // has ended its first round; and waits for its second one
      (* mem2reg *) logic [SLOT_BITS-1:0] place_q[SLOTS];
      logic [SLOT_BITS-1:0] head_q, tail_q;
      logic [SLOTS*SLOT_BITS-1:0] places;  // of this cycle's by number
      logic [SLOT_BITS-1:0] next_place;  // behind those that a line ended
      assign goes_again = two_rounds_i ? (filled_up | read_up) & ~second_q : '0;
      assign second_o = second_q[slot_o];
      assign again_valid = again_q != '0;
      always_comb begin
        again_slot = '0;
        for (int s = 0; s < SLOTS; s++) if (again_q[s] && place_q[s] == head_q) again_slot = SLOT_BITS'(s);
      end
      always_comb begin
        next_place = tail_q;
        for (int s = 0; s < SLOTS; s++) begin
          places[SLOT_BITS*s+:SLOT_BITS] = next_place;
          next_place = next_place + SLOT_BITS'(goes_again[s] && filled_up[s]);
        end
      end
      wire starts_again = starts_o && again;
      always_ff @(posedge clk_i) begin
        if (rst_i) begin
          head_q <= '0;
          tail_q <= '0;
        end else begin
          head_q <= head_q + SLOT_BITS'(starts_again);
          tail_q <= next_place + SLOT_BITS'((goes_again & read_up) != '0);
        end
      end
      for (genvar s = 0; s < SLOTS; s++) begin : g_slot
        always_ff @(posedge clk_i) begin
          if (goes_again[s]) place_q[s] <= read_up[s] ? next_place : places[SLOT_BITS*s+:SLOT_BITS];
          if (rst_i) begin
            again_q[s] <= 1'b0;
            second_q[s] <= 1'b0;
          end else begin
            if (goes_again[s]) again_q[s] <= 1'b1;
            else if (starts_again && 32'(slot_o) == s) again_q[s] <= 1'b0;
            if (filled_up[s] || read_up[s]) second_q[s] <= goes_again[s];
          end
        end
      end
    end else begin : g_once
      wire unused_two_rounds = two_rounds_i;
      assign goes_again = '0;
      assign again_valid = 1'b0;
      assign again_slot = '0;
      assign second_o = 1'b0;
    end
  endgenerate

  // Contexts that are done leave one a cycle.
  logic [SLOTS-1:0] finished_q;
  logic [SLOT_BITS-1:0] turn_q;
  logic any_finished;
  next_in_turn #(
      .PLACE_BITS(SLOT_BITS)
  ) leaver (
      .members_i(finished_q),
      .start_i(turn_q),
      .found_o(any_finished),
      .place_o(done_slot_o)
  );
  assign done_push_o = any_finished && done_ready_i;
  wire [SLOTS-1:0] left = done_push_o ? SLOTS'(1) << done_slot_o : '0;
  wire [SLOTS-1:0] needs_none = starts_o && none_i ? SLOTS'(1) << slot_o : '0;
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      finished_q <= '0;
      turn_q <= '0;
    end else begin
      finished_q <= (finished_q & ~left) | ((filled_up | read_up) & ~goes_again) | needs_none;
`ifdef CTU_MUTATE_FETCH_TURN_STAYS
      if (done_push_o) turn_q <= done_slot_o;
`else
      if (done_push_o) turn_q <= done_slot_o + SLOT_BITS'(1);
`endif
    end
  end

  // The account. When nothing moved, what is there now was there at the start of the cycle.
  always_comb begin
    if (fills_pop_o && wanted) activity_o = `CTU_FILL_PORT;
    else if (no_register) activity_o = `CTU_MSHRS_FULL;
    else if (no_room) activity_o = `CTU_MEMORY_PORT_FULL;
    else if (look_o || fills_pop_o || done_push_o || read) activity_o = `CTU_BUSY;
    else if (any_finished) activity_o = `CTU_OUTPUT_FULL;
    else if (reading_due_q != '0) activity_o = `CTU_BUSY;
    else activity_o = none_in_use ? `CTU_IDLE : `CTU_MEMORY;
  end
endmodule
