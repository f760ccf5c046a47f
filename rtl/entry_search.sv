// entry_search: the searches of all packets for the places where their rays go on alone: of each a queue of nodes that it
// is still to be asked about, and the entries found, nearest first.
//
//   latency what is tested in a cycle (tested_i) is answered LATENCY cycles later (answer_o); node, entries and count know
//           of it from the next cycle on
//   twin    ctu::reference::EntrySearch and EntryList (model/reference/entry_search.h, entry_list.h)
//
// A search begins with the root of the packet's tree, which is in no queue. Of a packet one node is under way at a time, so that what its
// search knows stands still from tested_i to answer_o. A queue is a ring in four banks, as no node has more than four
// children; the list of entries is one word, into which a new one is inserted by comparing it with all of them at once.
// Queue and list together never hold more than most_entries_i.
module entry_search #(
    parameter int PACKET_BITS = 3,
    parameter int ENTRIES = 8,      // of a packet at most, 1 .. 16
    parameter int LATENCY = 1,      // any from 0
    parameter int TREES = 1,        // with 1 the root is 0
    localparam int PACKETS = 1 << PACKET_BITS,
    localparam int COUNT_BITS = 5
) (
    input logic clk_i,
    input logic rst_i,

    input logic [COUNT_BITS-1:0] most_entries_i,  // strap: 1 .. ENTRIES

    // A packet begins its search; no ray of it begins before t.
    input logic                   begin_i,
    input logic [PACKET_BITS-1:0] begin_packet_i,
    input logic [           31:0] begin_t_i,
    input logic [           31:0] begin_root_i,

    // The node that a packet is asked about next.
    input  logic [PACKET_BITS-1:0] ask_packet_i,
    output logic [           31:0] ask_node_o,

    // The packet has been tested against the node's children, lane 0 lowest.
    input  logic                   tested_i,
    input  logic [PACKET_BITS-1:0] tested_packet_i,
    input  logic [          127:0] children_i,
    input  logic [            3:0] hit_i,            // some ray may meet the child
    input  logic [            3:0] sure_i,           // every ray does
    input  logic [          127:0] t0_i,
    output logic                   answer_o,
    output logic [PACKET_BITS-1:0] answer_packet_o,
    output logic                   done_o,           // with answer_o: the search has ended

    // Entries {t0, reference}, the nearest lowest; and how many there are.
    input  logic [PACKET_BITS-1:0] entries_packet_i,
    output logic [ 64*ENTRIES-1:0] entries_o,
    input  logic [PACKET_BITS-1:0] count_packet_i,
    output logic [ COUNT_BITS-1:0] count_o
);
  localparam int ROW_BITS = ENTRIES > 8 ? 2 : ENTRIES > 4 ? 1 : 0;  // of a packet's rows in a bank
  localparam int PLACE_BITS = ROW_BITS + 2;
  localparam int BANK_ROWS = PACKETS << ROW_BITS;
  localparam int ADDRESS_BITS = PACKET_BITS + ROW_BITS;

  // By packet. Head and tail count one bit more than a place, to tell full from empty.
  logic [PACKETS-1:0] at_root_q;
  logic [31:0] begins_q[PACKETS];
  logic [PLACE_BITS:0] head_q[PACKETS], tail_q[PACKETS];
  logic [COUNT_BITS-1:0] count_q[PACKETS];
  logic [64*ENTRIES-1:0] list_q[PACKETS];
  assign entries_o = list_q[entries_packet_i];
  assign count_o = count_q[count_packet_i];

  logic [31:0] ask_root, tested_root;
  generate
    if (TREES > 1) begin : g_roots
      logic [31:0] roots_q[PACKETS];
      always_ff @(posedge clk_i) if (begin_i) roots_q[begin_packet_i] <= begin_root_i;
      assign ask_root = roots_q[ask_packet_i];
      assign tested_root = roots_q[tested_packet_i];
    end else begin : g_root
      assign ask_root = 32'd0;
      assign tested_root = 32'd0;
      wire unused_root = &{1'b0, begin_root_i};
    end
  endgenerate

  // The heads of two queues: of the packet that asks, and of the one whose answer is sought.
  logic [4*64-1:0] ask_heads, tested_heads;
  wire [PLACE_BITS-1:0] ask_head = PLACE_BITS'(head_q[ask_packet_i]);
  assign ask_node_o = at_root_q[ask_packet_i] ? ask_root : ask_heads[64*32'(ask_head[1:0])+:32];

  // The answer: the node becomes an entry, or its children take its place.
  wire at_root = at_root_q[tested_packet_i];
  wire [PLACE_BITS:0] head = head_q[tested_packet_i];
  wire [PLACE_BITS:0] tail = tail_q[tested_packet_i];
  wire [PLACE_BITS:0] queued = tail - head;
  wire [COUNT_BITS-1:0] count = count_q[tested_packet_i];
  wire [63:0] node = at_root ? {begins_q[tested_packet_i], tested_root} : tested_heads[64*32'(head[1:0])+:64];
  wire [64*ENTRIES-1:0] list = list_q[tested_packet_i];
  wire unused_references = &{1'b0, list};
  logic [5:0] places;
  logic [2:0] hits, unsure;
  logic leaf, stays;
  always_comb begin
    hits = 3'd0;
    unsure = 3'd0;
    leaf = 1'b0;
    for (int lane = 0; lane < 4; lane++) begin
      hits = hits + 3'(hit_i[lane]);
      unsure = unsure + 3'(hit_i[lane] && !sure_i[lane]);
      leaf = leaf || (hit_i[lane] && children_i[32*lane+31]);
    end
    places = 6'(queued) - 6'(!at_root) + 6'(count) + 6'(hits);
`ifdef CTU_MUTATE_PACKET_DOUBTS
    stays = leaf || places > 6'(most_entries_i) || unsure > 3'd2;
`else
    stays = leaf || places > 6'(most_entries_i) || unsure > 3'd1;
`endif
  end
  // Which places of the list move up for the new entry, itself behind those of the same t0.
  logic [ENTRIES-1:0] moves;
  generate
    for (genvar i = 0; i < ENTRIES; i++) begin : g_place
      logic less;
      logic [1:0] unused_compare;
      float_compare compare (
          .a_i(node[63:32]),
          .b_i(list[64*i+32+:32]),
          .less_o(less),
          .equal_o(unused_compare[0]),
          .unordered_o(unused_compare[1])
      );
      assign moves[i] = less || COUNT_BITS'(i) >= count;
    end
  endgenerate

  // With LATENCY the answer in registers.
  logic stays_q;
  logic [3:0] hit_q;
  logic [127:0] children_q, t0_q;
  logic [63:0] node_q;
  logic [ENTRIES-1:0] moves_q;
  pipe_row #(
      .WIDTH(PACKET_BITS + 5 + 256 + 64 + ENTRIES),
      .DEPTH(LATENCY)
  ) row_answer (
      .clk_i,
      .enable_i(1'b1),
      .data_i({tested_packet_i, stays, hit_i, children_i, t0_i, node, moves}),
      .data_o({answer_packet_o, stays_q, hit_q, children_q, t0_q, node_q, moves_q})
  );
  generate
    if (LATENCY == 0) begin : g_at_once
      assign answer_o = tested_i;
    end else begin : g_later
      logic [LATENCY-1:0] answers_q;
      assign answer_o = answers_q[LATENCY-1];
      always_ff @(posedge clk_i) begin
        if (rst_i) answers_q <= '0;
        else answers_q <= LATENCY'({answers_q, tested_i});
      end
    end
  endgenerate

  // What it changes.
  wire answer_at_root = at_root_q[answer_packet_o];
  wire [PLACE_BITS:0] new_head = head_q[answer_packet_o] + (PLACE_BITS + 1)'(!answer_at_root);
  wire [PLACE_BITS:0] old_tail = tail_q[answer_packet_o];
  wire [COUNT_BITS-1:0] old_count = count_q[answer_packet_o];
  logic [2:0] pushed;
  logic [7:0] order;  // of the children pushed: which place of the queue is a lane's
  always_comb begin
    pushed = 3'd0;
    for (int lane = 0; lane < 4; lane++) begin
      order[2*lane+:2] = pushed[1:0];
      pushed = pushed + 3'(hit_q[lane] && !stays_q);
    end
  end
  wire [PLACE_BITS:0] new_tail = old_tail + (PLACE_BITS + 1)'(pushed);
  assign done_o = new_head == new_tail;

  always_ff @(posedge clk_i) begin
    if (begin_i) begin
      at_root_q[begin_packet_i] <= 1'b1;
      begins_q[begin_packet_i] <= begin_t_i;
      head_q[begin_packet_i] <= '0;
      tail_q[begin_packet_i] <= '0;
      count_q[begin_packet_i] <= '0;
    end
    if (answer_o) begin
      at_root_q[answer_packet_o] <= 1'b0;
      head_q[answer_packet_o] <= new_head;
      tail_q[answer_packet_o] <= new_tail;
      if (stays_q) count_q[answer_packet_o] <= old_count + COUNT_BITS'(1);
    end
  end

  wire [64*ENTRIES-1:0] old_list = list_q[answer_packet_o];
  logic [64*ENTRIES-1:0] new_list;
  generate
    for (genvar i = 0; i < ENTRIES; i++) begin : g_insert
      if (i == 0) begin : g_first
        assign new_list[63:0] = moves_q[0] ? node_q : old_list[63:0];
      end else begin : g_other
        assign new_list[64*i+:64] =
            !moves_q[i] ? old_list[64*i+:64] : moves_q[i-1] ? old_list[64*(i-1)+:64] : node_q;
      end
    end
  endgenerate
  always_ff @(posedge clk_i) if (answer_o && stays_q) list_q[answer_packet_o] <= new_list;

  generate
    for (genvar bank = 0; bank < 4; bank++) begin : g_bank
      logic [63:0] queue_q[BANK_ROWS];
      assign ask_heads[64*bank+:64] = queue_q[ADDRESS_BITS'({ask_packet_i, ask_head} >> 2)];
      assign tested_heads[64*bank+:64] = queue_q[ADDRESS_BITS'({tested_packet_i, head[PLACE_BITS-1:0]} >> 2)];

      // Which of the children comes here, if any.
      wire [1:0] which = 2'(bank) - old_tail[1:0];
      wire [PLACE_BITS-1:0] place = old_tail[PLACE_BITS-1:0] + PLACE_BITS'(which);
      logic [63:0] child;
      always_comb begin
        child = 64'd0;
        for (int lane = 0; lane < 4; lane++)
          if (hit_q[lane] && order[2*lane+:2] == which) child = {t0_q[32*lane+:32], children_q[32*lane+:32]};
      end
      always_ff @(posedge clk_i)
        if (answer_o && {1'b0, which} < pushed) queue_q[ADDRESS_BITS'({answer_packet_o, place} >> 2)] <= child;
    end
  endgenerate
endmodule
