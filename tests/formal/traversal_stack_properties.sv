// What traversal_stack promises (rtl/traversal_stack.sv) for any of its contexts, named by context_i; the other one
// may send tokens and get refills as it likes.
//
// An entry is marked when a node with it is taken: it has a place in the stack, counted from the bottom, and leaves
// when the stack has been popped down to it, with its own reference, or is dropped by its own t0. As any entry can be
// marked, the stack gives back what was pushed, last in first out, however often it was spilled and refilled on the
// way. Memory is abstract: it keeps what was written at the marked entry's address, and anything is read elsewhere.
`include "tokens.svh"

module traversal_stack_properties (
    input logic         clk_i,
    input logic         rst_i,
    input logic [  6:0] entries_i,
    input logic [  1:0] push_width_i,
    input logic [  6:0] spill_batch_i,
    input logic         sorted_valid_i,
    input logic [ 20:0] sorted_data_i,
    input logic         leaf_done_valid_i,
    input logic [  1:0] leaf_done_data_i,
    input logic         refills_valid_i,
    input logic [263:0] refills_data_i,
    input logic         to_scheduler_ready_i,
    input logic         to_result_ready_i,
    input logic         spills_ready_i,
    input logic [127:0] children_i,
    input logic [127:0] t0_i,
    input logic [ 31:0] best_t_i,
    input logic         context_i,
    input logic         mark_i,         // mark an entry of the node that is taken
    input logic [  1:0] mark_number_i   // which survivor, 1 to 3
);
  localparam logic [11:0] BASE = 12'd64;
  localparam logic [11:0] REGION = 12'd1024;

  logic sorted_pop, leaf_done_pop, refills_pop, to_scheduler_push, to_result_push, spills_push;
  logic [32:0] to_scheduler_data;
  logic to_result_data;
  logic [276:0] spills_data;
  traversal_stack #(
      .SLOT_BITS(1),
      .MAX_ENTRIES(4),
      .DEPTH_BITS(7),
      .ADDRESS_BITS(12),
      .LINE_BYTES(32)
  ) dut (
      .clk_i,
      .rst_i,
      .entries_i,
      .push_width_i,
      .spill_batch_i,
      .spill_base_i(BASE),
      .spill_region_i(REGION),
      .sorted_valid_i,
      .sorted_data_i,
      .sorted_pop_o(sorted_pop),
      .leaf_done_valid_i,
      .leaf_done_data_i,
      .leaf_done_pop_o(leaf_done_pop),
      .refills_valid_i,
      .refills_data_i,
      .refills_pop_o(refills_pop),
      .to_scheduler_ready_i,
      .to_scheduler_push_o(to_scheduler_push),
      .to_scheduler_data_o(to_scheduler_data),
      .to_result_ready_i,
      .to_result_push_o(to_result_push),
      .to_result_data_o(to_result_data),
      .spills_ready_i,
      .spills_push_o(spills_push),
      .spills_data_o(spills_data),
      .slot_o(),
      .children_i,
      .t0_i,
      .best_t_i,
      .visit_valid_o(),
      .visit_slot_o(),
      .activity_o()
  );
  // An entry that is dropped does not show at the ports, so this is looked up inside.
  (* hierconn *) wire \dut.pops , \dut.slot_q ;

  // What the context's ray does.
  wire [3:0] survivors = sorted_data_i[15:12];
  wire [2:0] count = 3'(survivors[0]) + 3'(survivors[1]) + 3'(survivors[2]) + 3'(survivors[3]);
  wire visits = sorted_pop && sorted_data_i[20] == context_i;
  wire pushes = visits && count != 3'd0;
  wire returns = leaf_done_pop && leaf_done_data_i[1] == context_i;
  wire refilled = refills_pop && refills_data_i[256] == context_i;
  wire pops = \dut.pops && \dut.slot_q == context_i;
  wire passes = to_scheduler_push && to_scheduler_data[32] == context_i;
  wire finishes = to_result_push && to_result_data == context_i;
  wire [11:0] address = spills_data[276:265];
  wire requests = spills_push && spills_data[257] == context_i;
  wire writes = spills_data[256];

  // The stack as it should be once the node in work is pushed.
  logic away_q, reading_q, pushing_q, done_q;
  logic [7:0] depth_q, spilled_q;
  logic [1:0] nearest_q;
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      away_q <= 1'b1;
      reading_q <= 1'b0;
      pushing_q <= 1'b0;
      done_q <= 1'b0;
      depth_q <= 8'd0;
      spilled_q <= 8'd0;
    end else begin
      away_q <= passes || finishes || (away_q && !visits && !returns);
      reading_q <= (requests && !writes) || (reading_q && !refilled);
      pushing_q <= pushes || (pushing_q && !passes);
      done_q <= (returns && leaf_done_data_i[0]) || (done_q && !finishes);
      depth_q <= finishes ? 8'd0 : depth_q + (pushes ? 8'(count) - 8'd1 : 8'd0) - 8'(pops);
      spilled_q <= finishes ? 8'd0 : spilled_q + (requests && writes ? 8'(spill_batch_i) : 8'd0) -
                   (refilled ? 8'(spill_batch_i) : 8'd0);
    end
    if (pushes) nearest_q <= sorted_data_i[5:4];
  end

  // The marked entry. Its value is there from the cycle after the one in which its node is taken.
  logic marked_q, fresh_q, written_q, back_q;  // written_q, back_q: it has been spilled; and refilled
  logic [7:0] place_q;
  logic [1:0] lane_q;
  logic [63:0] value_q, memory_q;
  wire [7:0] refill_first = spilled_q - 8'(spill_batch_i);  // of what comes back
  wire [63:0] current = {t0_i[32*32'(lane_q)+:32], children_i[32*32'(lane_q)+:32]};
  wire [63:0] value = fresh_q ? current : value_q;
  wire marks = pushes && mark_i && !marked_q && mark_number_i != 2'd0 && 3'(mark_number_i) < count;
  wire on_top = marked_q && depth_q == place_q + 8'd1;
  wire [11:0] place_address = BASE + (context_i ? REGION : 12'd0) + (12'(place_q) << 3);
  wire kept = spills_push && writes && address <= place_address && place_address < address + (12'(spill_batch_i) << 3);
  always_ff @(posedge clk_i) begin
    marked_q <= !rst_i && (marks || (marked_q && !finishes && !(pops && on_top)));
    fresh_q <= !rst_i && marks;
    written_q <= !rst_i && !marks && (kept || written_q);
    back_q <= !rst_i && !marks && ((refilled && written_q && place_q >= refill_first && place_q < spilled_q) || back_q);
    if (marks) begin
      place_q <= depth_q + 8'(count) - 8'd1 - 8'(mark_number_i);
      lane_q <= sorted_data_i[4+2*32'(mark_number_i)+:2];
    end
    value_q <= value;
    if (kept) memory_q <= spills_data[64*32'(place_q[1:0])+:64];
  end
  logic less, equal, unused_unordered;
  float_compare compare (
      .a_i(value[63:32]),
      .b_i(best_t_i),
      .less_o(less),
      .equal_o(equal),
      .unordered_o(unused_unordered)
  );

  // Rules of the ports.
  logic started_q = 1'b0;
  logic held_q;  // the registers of the node in work have been read
  logic [127:0] children_q, t0_q;
  logic [16:0] straps_q;
  wire [16:0] straps = {entries_i, push_width_i, spill_batch_i, context_i};
  always_ff @(posedge clk_i) begin
    started_q <= 1'b1;
    held_q <= !rst_i && pushing_q && !passes;
    children_q <= children_i;
    t0_q <= t0_i;
    straps_q <= straps;
  end
  always_comb begin
    assume (started_q || rst_i);
    assume (!started_q || straps == straps_q);
    assume (entries_i != 7'd0 && entries_i <= 7'd4 && push_width_i != 2'd0);
    assume (spill_batch_i == 7'd1 || spill_batch_i == 7'd2 || spill_batch_i == 7'd4);
    assume (spill_batch_i <= entries_i);
    assume (!held_q || (children_i == children_q && t0_i == t0_q));
    assume (!(sorted_valid_i && sorted_data_i[20] == context_i) || away_q);
    assume (!(leaf_done_valid_i && leaf_done_data_i[1] == context_i) ||
            (away_q && !(sorted_valid_i && sorted_data_i[20] == context_i)));
    assume (!pushes || depth_q + 8'(count) <= 8'd128);  // fewer than 1 << DEPTH_BITS entries
    assume (!(refills_valid_i && refills_data_i[256] == context_i) || reading_q);
    assume (!refilled || !marked_q || place_q < refill_first || place_q >= spilled_q ||
            refills_data_i[64*32'(place_q[1:0])+:64] == memory_q);
  end

  always_comb begin
    if (started_q) begin
      one_place : assert (!(passes && finishes) &&
                          !((passes || finishes || pops || requests) && (away_q || reading_q)));
      nearest : assert (!(passes && pushing_q) ||
                        (!pops && to_scheduler_data[31:0] == children_i[32*32'(nearest_q)+:32]));
      popped : assert (!(passes && !pushing_q) || (pops && !done_q));
      not_empty : assert (!pops || (depth_q != 8'd0 && !pushing_q));
      own_value : assert (!(pops && passes && on_top) || (to_scheduler_data[31:0] == value[31:0] && (less || equal)));
      dropped : assert (!(pops && !passes && on_top) || !(less || equal));
      empty : assert (!finishes || depth_q == 8'd0 || done_q);
      spill : assert (!(requests && writes) ||
                      address == BASE + (context_i ? REGION : 12'd0) + (12'(spilled_q) << 3));
      refill : assert (!(requests && !writes) || (depth_q == spilled_q && depth_q != 8'd0 &&
                       address == BASE + (context_i ? REGION : 12'd0) + (12'(refill_first) << 3)));
      inside : assert (!marked_q || place_q < depth_q);
      spilled_and_back : cover (pops && passes && on_top && back_q);
    end
  end

`ifdef CTU_INVARIANTS
  // Registers inside, under the names that they have after flattening.
  (* hierconn *) wire [1:0] \dut.job_q , \dut.to_push_q , \dut.occupied_q ;
  (* hierconn *) wire [7:0] \dut.order_q ;
  (* hierconn *) wire [6:0] \dut.depth_q , \dut.spilled_q ;
  (* hierconn *) wire [6:0] \dut.depths_q[0] , \dut.depths_q[1] , \dut.spilleds_q[0] , \dut.spilleds_q[1] ;
  (* hierconn *) wire [63:0] \dut.g_bank[0].entries_q[0] , \dut.g_bank[0].entries_q[1] ;
  (* hierconn *) wire [63:0] \dut.g_bank[1].entries_q[0] , \dut.g_bank[1].entries_q[1] ;
  (* hierconn *) wire [63:0] \dut.g_bank[2].entries_q[0] , \dut.g_bank[2].entries_q[1] ;
  (* hierconn *) wire [63:0] \dut.g_bank[3].entries_q[0] , \dut.g_bank[3].entries_q[1] ;
  wire [127:0] low_row = context_i ? {\dut.g_bank[1].entries_q[1] , \dut.g_bank[0].entries_q[1] } :
                                     {\dut.g_bank[1].entries_q[0] , \dut.g_bank[0].entries_q[0] };
  wire [127:0] high_row = context_i ? {\dut.g_bank[3].entries_q[1] , \dut.g_bank[2].entries_q[1] } :
                                      {\dut.g_bank[3].entries_q[0] , \dut.g_bank[2].entries_q[0] };
  wire [255:0] row = {high_row, low_row};
  wire served = \dut.job_q != 2'd0 && \dut.slot_q == context_i;
  wire occupied = context_i ? \dut.occupied_q [1] : \dut.occupied_q [0];
  wire [6:0] kept_depth = context_i ? \dut.depths_q[1] : \dut.depths_q[0] ;
  wire [6:0] kept_spilled = context_i ? \dut.spilleds_q[1] : \dut.spilleds_q[0] ;
  wire [7:0] depth = 8'(served ? \dut.depth_q : occupied ? kept_depth : 7'd0);
  wire [7:0] spilled = 8'(served ? \dut.spilled_q : occupied ? kept_spilled : 7'd0);
  wire [6:0] within = spill_batch_i - 7'd1;
  wire [7:0] number = depth_q - place_q;  // of the marked entry while it is still to be pushed
  wire [63:0] held = {t0_q[32*32'(lane_q)+:32], children_q[32*32'(lane_q)+:32]};
  always_comb begin
    if (started_q) begin
      whereabouts : assert (2'(away_q) + 2'(reading_q) + 2'(served) == 2'd1);
      jobs : assert ((pushing_q == (served && \dut.job_q == 2'd1)) && (done_q == (served && \dut.job_q == 2'd3)));
      depths : assert (depth_q <= 8'd127 && depth_q == depth + (pushing_q ? 8'(\dut.to_push_q ) : 8'd0));
      spilled_ones : assert (spilled_q == spilled && spilled <= depth && depth - spilled <= 8'(entries_i));
      whole_batches : assert ((\dut.job_q == 2'd0 || (\dut.spilled_q & within) == 7'd0) &&
                              (!\dut.occupied_q [0] || (\dut.spilleds_q[0] & within) == 7'd0) &&
                              (!\dut.occupied_q [1] || (\dut.spilleds_q[1] & within) == 7'd0));
      waits_for_line : assert (!reading_q || (depth_q == spilled_q && depth_q != 8'd0));
      first_to_pass : assert (!pushing_q || \dut.order_q [1:0] == nearest_q);
      new_node : assert (!fresh_q || (marked_q && pushing_q && !held_q && place_q >= depth));
      read_before : assert (!held_q || pushing_q);
      to_be_pushed : assert (!marked_q || place_q < depth || (pushing_q && number != 8'd0 &&
                             number <= 8'(\dut.to_push_q ) && \dut.order_q [2*32'(number[1:0])+:2] == lane_q &&
                             (fresh_q || (held_q && value_q == held))));
      in_memory : assert (!marked_q || place_q >= spilled || memory_q == value_q);
    end
  end
  // The marked entry lies in one bank; a property for each is proved sooner than one for all.
  wire on_chip = marked_q && place_q >= spilled && place_q < depth;
  always_comb begin
    if (started_q) begin
      bank_0 : assert (!on_chip || place_q[1:0] != 2'd0 || row[0+:64] == value_q);
      bank_1 : assert (!on_chip || place_q[1:0] != 2'd1 || row[64+:64] == value_q);
      bank_2 : assert (!on_chip || place_q[1:0] != 2'd2 || row[128+:64] == value_q);
      bank_3 : assert (!on_chip || place_q[1:0] != 2'd3 || row[192+:64] == value_q);
    end
  end
`endif
endmodule
