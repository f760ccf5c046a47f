// scheduler: chooses which ready ray is issued next, one a cycle, to node_fetch or leaf_fetch by the kind of its
// reference.
//
//   latency 1 (a ray that comes in cycle t can be issued in t + 1), one issue a cycle
//   twin    model/pipeline/scheduler.h
//   stated  docs/unit.md
//
// It takes a ray from the stack and one from ray_queue in every cycle, as there is room for every context. References
// lie in a file by context. The policy oldest keeps a queue of contexts for each fetch stage and compares the arrival
// numbers of the two in front; round robin keeps a bit for each context. Both are kept up to date under their policy
// only.
`include "tokens.svh"

module scheduler #(
    parameter int SLOT_BITS = 5,
    parameter bit PACKETS = 1'b0,  // what comes from rays are nodes of packets
    localparam int OF_PACKET = PACKETS ? 1 : 0
) (
    input  logic                  clk_i,
    input  logic                  rst_i,
    input  logic                  policy_round_robin_i,   // strap: scheduler.policy
    input  logic                  from_stack_valid_i,
    input  logic [SLOT_BITS+31:0] from_stack_data_i,      // a ref
    output logic                  from_stack_pop_o,
    input  logic                  from_rays_valid_i,
    input  logic [SLOT_BITS+31:0] from_rays_data_i,       // a ref
    output logic                  from_rays_pop_o,
    input  logic                  to_node_fetch_ready_i,
    output logic                  to_node_fetch_push_o,
    output logic [SLOT_BITS+31+OF_PACKET:0] to_node_fetch_data_o,  // a ref; with PACKETS whether it is a packet's above
    input  logic                  to_leaf_fetch_ready_i,
    output logic                  to_leaf_fetch_push_o,
    output logic [SLOT_BITS+31:0] to_leaf_fetch_data_o,   // a ref
    output logic [           3:0] activity_o
);
  localparam int SLOTS = 1 << SLOT_BITS;

  // What comes in: first what the stack sends, as in the order of arrival.
  assign from_stack_pop_o = from_stack_valid_i;
  assign from_rays_pop_o = from_rays_valid_i;
  wire [SLOT_BITS-1:0] stack_slot = from_stack_data_i[32+:SLOT_BITS];
  wire [SLOT_BITS-1:0] rays_slot = from_rays_data_i[32+:SLOT_BITS];
  // The highest bit of a reference says that it is a leaf; references of empty lanes are never visited.
  wire stack_leaf = from_stack_data_i[31];
  wire rays_leaf = from_rays_data_i[31];

  // References and arrival numbers by context. The numbers go round; the sign of a difference orders them as long as
  // nobody is overtaken by 2^31 others.
  logic [31:0] arrivals_q;
  logic [31:0] rays_arrival;
  assign rays_arrival = arrivals_q + {31'd0, from_stack_valid_i};
  always_ff @(posedge clk_i) begin
    if (rst_i) arrivals_q <= 32'd0;
    else arrivals_q <= rays_arrival + {31'd0, from_rays_valid_i};
  end

  logic [63:0] file_q[SLOTS];
  always_ff @(posedge clk_i) begin
    if (from_stack_valid_i) file_q[stack_slot] <= {arrivals_q, from_stack_data_i[31:0]};
    if (from_rays_valid_i) file_q[rays_slot] <= {rays_arrival, from_rays_data_i[31:0]};
  end

  // Oldest: the front of each queue, and of both the older.
  logic node_waits, leaf_waits, node_pop, leaf_pop;
  logic [SLOT_BITS-1:0] node_front, leaf_front;
  arrival_queue #(
      .SLOT_BITS(SLOT_BITS)
  ) node_queue (
      .clk_i,
      .rst_i,
      .first_push_i(!policy_round_robin_i && from_stack_valid_i && !stack_leaf),
      .first_slot_i(stack_slot),
      .second_push_i(!policy_round_robin_i && from_rays_valid_i && !rays_leaf),
      .second_slot_i(rays_slot),
      .pop_i(node_pop),
      .valid_o(node_waits),
      .slot_o(node_front)
  );
  arrival_queue #(
      .SLOT_BITS(SLOT_BITS)
  ) leaf_queue (
      .clk_i,
      .rst_i,
      .first_push_i(!policy_round_robin_i && from_stack_valid_i && stack_leaf),
      .first_slot_i(stack_slot),
      .second_push_i(!policy_round_robin_i && from_rays_valid_i && rays_leaf),
      .second_slot_i(rays_slot),
      .pop_i(leaf_pop),
      .valid_o(leaf_waits),
      .slot_o(leaf_front)
  );

  // Round robin: the next context by number among those whose fetch stage takes one.
  logic [SLOTS-1:0] node_set_q, leaf_set_q;
  logic [SLOT_BITS-1:0] turn_q, turn_slot;
  logic turn_found;
  next_in_turn #(
      .PLACE_BITS(SLOT_BITS)
  ) next (
      .members_i((node_set_q & {SLOTS{to_node_fetch_ready_i}}) | (leaf_set_q & {SLOTS{to_leaf_fetch_ready_i}})),
      .start_i(turn_q),
      .found_o(turn_found),
      .place_o(turn_slot)
  );

  // The one file serves both policies: one port reads the front node or the context whose turn it is, one the front
  // leaf.
  wire [63:0] node_or_turn = file_q[policy_round_robin_i ? turn_slot : node_front];
  wire [63:0] leaf = file_q[leaf_front];
  wire [31:0] leaf_after_node = leaf[63:32] - node_or_turn[63:32];
  logic node_can, leaf_can, leaf_first, issue, issue_leaf;
  logic [SLOT_BITS+31:0] issued;
  always_comb begin
    node_can = node_waits && to_node_fetch_ready_i;
    leaf_can = leaf_waits && to_leaf_fetch_ready_i;
`ifdef CTU_MUTATE_SCHEDULER_NODES_FIRST
    leaf_first = leaf_can && !node_can;
`else
    leaf_first = leaf_can && (!node_can || leaf_after_node[31]);
`endif
    if (policy_round_robin_i) begin
      issue = turn_found;
      issued = {turn_slot, node_or_turn[31:0]};
    end else begin
      issue = node_can || leaf_can;
      issued = leaf_first ? {leaf_front, leaf[31:0]} : {node_front, node_or_turn[31:0]};
    end
    issue_leaf = issued[31];
    node_pop = !policy_round_robin_i && issue && !issue_leaf;
    leaf_pop = !policy_round_robin_i && issue && issue_leaf;
  end
  wire unused_difference = &{1'b0, leaf_after_node[30:0]};
  assign to_node_fetch_push_o = issue && !issue_leaf;
  assign to_leaf_fetch_push_o = issue && issue_leaf;
  generate
    if (PACKETS) begin : g_packets
      logic [SLOTS-1:0] of_packet_q;  // by context
      always_ff @(posedge clk_i) begin
        if (from_stack_valid_i) of_packet_q[stack_slot] <= 1'b0;
        if (from_rays_valid_i) of_packet_q[rays_slot] <= 1'b1;
      end
      assign to_node_fetch_data_o = {of_packet_q[issued[32+:SLOT_BITS]], issued};
    end else begin : g_alone
      assign to_node_fetch_data_o = issued;
    end
  endgenerate
  assign to_leaf_fetch_data_o = issued;

  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      node_set_q <= '0;
      leaf_set_q <= '0;
      turn_q <= '0;
    end else if (policy_round_robin_i) begin
      if (issue) begin
        node_set_q[turn_slot] <= 1'b0;
        leaf_set_q[turn_slot] <= 1'b0;
`ifndef CTU_MUTATE_SCHEDULER_LOWEST_FIRST
        turn_q <= turn_slot + SLOT_BITS'(1);
`endif
      end
      if (from_stack_valid_i) begin
        node_set_q[stack_slot] <= !stack_leaf;
        leaf_set_q[stack_slot] <= stack_leaf;
      end
      if (from_rays_valid_i) begin
        node_set_q[rays_slot] <= !rays_leaf;
        leaf_set_q[rays_slot] <= rays_leaf;
      end
    end
  end

  always_comb begin
    if (issue) activity_o = `CTU_BUSY;
    else if (node_waits || leaf_waits || (node_set_q | leaf_set_q) != '0) activity_o = `CTU_OUTPUT_FULL;
    else activity_o = `CTU_IDLE;
  end
endmodule
