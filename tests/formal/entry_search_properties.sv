// What entry_search promises (rtl/entry_search.sv) of a packet's search, while tests come for packets that have asked and
// never twice for one node; the other packet may search as it likes.
//
// A child is marked when it goes into the queue: it is asked for at its own place in the order, and if it becomes an
// entry, it is one of them until the packet's next search, however many come before it or behind. As any child can be
// marked, none is lost or doubled. Entries are always in the order of their t0.
module entry_search_properties #(
    parameter int ENTRIES = 3
) (
    input logic         clk_i,
    input logic         rst_i,
    input logic [  4:0] most_entries_i,
    input logic         begin_i,
    input logic         begin_packet_i,
    input logic [ 31:0] begin_t_i,
    input logic         tested_i,
    input logic         tested_packet_i,
    input logic [127:0] children_i,
    input logic [  3:0] hit_i,
    input logic [  3:0] sure_i,
    input logic [127:0] t0_i,
    input logic         mark_i,           // mark a child of packet 0
    input logic [  1:0] mark_lane_i
);
  logic [31:0] node;
  logic answer, answer_packet, done;
  logic [64*ENTRIES-1:0] entries;
  logic [4:0] count;
  entry_search #(
      .PACKET_BITS(1),
      .ENTRIES(ENTRIES),
      .LATENCY(0)
  ) dut (
      .clk_i,
      .rst_i,
      .most_entries_i,
      .begin_i,
      .begin_packet_i,
      .begin_t_i,
      .begin_root_i(32'd0),
      .ask_packet_i(1'b0),
      .ask_node_o(node),
      .tested_i,
      .tested_packet_i,
      .children_i,
      .hit_i,
      .sure_i,
      .t0_i,
      .answer_o(answer),
      .answer_packet_o(answer_packet),
      .done_o(done),
      .entries_packet_i(1'b0),
      .entries_o(entries),
      .count_packet_i(1'b0),
      .count_o(count)
  );

  function is_number(input [31:0] bits);
    is_number = bits[30:0] <= 31'h7f800000;
  endfunction
  // As unsigned numbers the keys order as the numbers do; both zeros are one.
  function [31:0] key(input [31:0] bits);
    key = bits[30:0] == 31'd0 ? 32'h80000000 : bits[31] ? ~bits : {1'b1, bits[30:0]};
  endfunction

  // Packets under search, nodes in packet 0's queue, the root included; and the marked one: how many are before it.
  logic [1:0] open_q;
  logic [4:0] queued_q, before_q;
  logic marked_q, entered_q;
  logic [63:0] mark_q;
  wire mine = tested_i && !tested_packet_i;
  wire [4:0] after = {4'd0, hit_i[0]} + {4'd0, hit_i[1]} + {4'd0, hit_i[2]} + {4'd0, hit_i[3]};
  wire [4:0] rest = queued_q - 5'd1;
  logic [4:0] lane_place;
  always_comb begin
    lane_place = 5'd0;
    for (int lane = 0; lane < 4; lane++) if (2'(lane) < mark_lane_i) lane_place = lane_place + {4'd0, hit_i[lane]};
  end
  // The rule: the node stays as an entry.
  logic [2:0] unsure;
  logic leaf;
  always_comb begin
    unsure = 3'd0;
    leaf = 1'b0;
    for (int lane = 0; lane < 4; lane++) begin
      unsure = unsure + {2'd0, hit_i[lane] && !sure_i[lane]};
      leaf = leaf || (hit_i[lane] && children_i[32*lane+31]);
    end
  end
  wire stays = mine && (leaf || unsure > 3'd1 || 32'(rest) + 32'(count) + 32'(after) > 32'(most_entries_i));
  wire marks = mine && !stays && mark_i && hit_i[mark_lane_i] && !marked_q && !entered_q;
  wire arrives = marked_q && mine && before_q == 5'd0;

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  logic [4:0] most_q;
  always_ff @(posedge clk_i) most_q <= most_entries_i;
  always_comb begin
    assume (started_q || rst_i);
    assume (most_entries_i >= 5'd1 && most_entries_i <= 5'(ENTRIES));
    assume (!started_q || most_entries_i == most_q);
    assume (!begin_i || !open_q[begin_packet_i]);
    assume (!tested_i || open_q[tested_packet_i]);
    assume (is_number(begin_t_i));
    for (int lane = 0; lane < 4; lane++) assume (is_number(t0_i[32*lane+:32]));
  end

  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      open_q <= 2'd0;
      queued_q <= 5'd0;
      marked_q <= 1'b0;
      entered_q <= 1'b0;
    end else begin
      if (tested_i && done) open_q[tested_packet_i] <= 1'b0;
      if (begin_i) open_q[begin_packet_i] <= 1'b1;
      if (begin_i && !begin_packet_i) begin
        queued_q <= 5'd1;
        marked_q <= 1'b0;
        entered_q <= 1'b0;
      end else if (mine) begin
        queued_q <= stays ? rest : rest + after;
        marked_q <= marks || (marked_q && !arrives);
        entered_q <= entered_q || (arrives && stays);
        before_q <= marks ? rest + lane_place : before_q - 5'd1;
        if (marks) mark_q <= {t0_i[32*mark_lane_i+:32], children_i[32*mark_lane_i+:32]};
      end
    end
  end

  logic at_root_q;  // packet 0 has not been tested yet
  always_ff @(posedge clk_i) begin
    if (begin_i && !begin_packet_i) at_root_q <= 1'b1;
    else if (mine) at_root_q <= 1'b0;
  end

  logic listed, sorted;
  always_comb begin
    listed = 1'b0;
    sorted = 1'b1;
    for (int i = 0; i < ENTRIES; i++) if (5'(i) < count && entries[64*i+:64] == mark_q) listed = 1'b1;
    for (int i = 1; i < ENTRIES; i++)
      if (5'(i) < count && key(entries[64*i+32+:32]) < key(entries[64*i-32+:32])) sorted = 1'b0;
  end
  always_comb begin
    if (started_q) begin
      answers : assert (answer == tested_i && (!tested_i || answer_packet == tested_packet_i));
      ends : assert (!mine || done == ((stays ? rest : rest + after) == 5'd0));
      room : assert (!open_q[0] || 32'(queued_q) + 32'(count) <= 32'(most_entries_i));
      asks : assert (!(marked_q && before_q == 5'd0) || node == mark_q[31:0]);
      root : assert (!(open_q[0] && count == 5'd0 && queued_q == 5'd1 && at_root_q) || node == 32'd0);
      kept : assert (!entered_q || listed);
      order : assert (!open_q[0] || sorted);
      full : cover (open_q[0] && count == 5'(ENTRIES) - 5'd1 && queued_q == 5'd1 && entered_q);
      behind : cover (entered_q && count == 5'd2 && entries[63:0] != mark_q && key(entries[63:32]) < key(mark_q[63:32]));
      waits : cover (marked_q && before_q == 5'd1 && mine);
    end
  end

`ifdef CTU_INVARIANTS
  // Registers inside, under the names that they have after flattening. Packet 0's ring is the first row of each bank.
  (* hierconn *) wire [1:0] \dut.at_root_q ;
  (* hierconn *) wire [31:0] \dut.begins_q[0] ;
  (* hierconn *) wire [2:0] \dut.head_q[0] , \dut.tail_q[0] ;
  (* hierconn *) wire [63:0] \dut.g_bank[0].queue_q[0] , \dut.g_bank[1].queue_q[0] , \dut.g_bank[2].queue_q[0] ,
                             \dut.g_bank[3].queue_q[0] ;
  wire [255:0] ring = {\dut.g_bank[3].queue_q[0] , \dut.g_bank[2].queue_q[0] , \dut.g_bank[1].queue_q[0] ,
                       \dut.g_bank[0].queue_q[0] };
  wire [2:0] in_ring = \dut.tail_q[0] - \dut.head_q[0] ;
  wire [1:0] place = 2'(\dut.head_q[0] + before_q[2:0]);
  logic numbers;
  always_comb begin
    numbers = 1'b1;
    for (int i = 0; i < 4; i++)
      if (3'(i) < in_ring && !is_number(ring[64*32'(2'(\dut.head_q[0] + 3'(i)))+32+:32])) numbers = 1'b0;
    for (int i = 0; i < ENTRIES; i++) if (5'(i) < count && !is_number(entries[64*i+32+:32])) numbers = 1'b0;
  end
  always_comb begin
    if (started_q) begin
      closed_marks : assert (!marked_q || open_q[0]);
      has_nodes : assert (!open_q[0] || queued_q != 5'd0);
      ring_count : assert (!open_q[0] || (\dut.at_root_q [0] ? in_ring == 3'd0 && queued_q == 5'd1 && count == 5'd0 :
                                          5'(in_ring) == queued_q));
      same_root : assert (!open_q[0] || at_root_q == \dut.at_root_q [0]);
      first_is_number : assert (!(open_q[0] && at_root_q) || is_number(\dut.begins_q[0] ));
      no_marks_yet : assert (!(open_q[0] && at_root_q) || (!marked_q && !entered_q));
      marked_inside : assert (!marked_q || before_q < queued_q);
      marked_place : assert (!marked_q || ring[64*32'(place)+:64] == mark_q);
      all_numbers : assert (!open_q[0] || numbers);
      limit : assert (!entered_q || count <= 5'(ENTRIES));
    end
  end
`endif
endmodule
