// arrival_queue: contexts in the order in which they came, up to two a cycle; it has room for all.
//
//   latency 1: what is pushed in cycle t can be popped from t + 1 on. pop_i only with valid_o
//   twin    ArrivalQueue of model/pipeline/scheduler.h
module arrival_queue #(
    parameter int SLOT_BITS = 5
) (
    input  logic                 clk_i,
    input  logic                 rst_i,
    input  logic                 first_push_i,   // before the second one in the same cycle
    input  logic [SLOT_BITS-1:0] first_slot_i,
    input  logic                 second_push_i,
    input  logic [SLOT_BITS-1:0] second_slot_i,
    input  logic                 pop_i,
    output logic                 valid_o,
    output logic [SLOT_BITS-1:0] slot_o
);
  logic [SLOT_BITS-1:0] ring_q[1 << SLOT_BITS];
  logic [SLOT_BITS:0] head_q, tail_q;  // one bit more than a place, to tell full from empty

`ifdef CTU_MUTATE_SCHEDULER_RAYS_FIRST
  wire [SLOT_BITS-1:0] second_place = tail_q[SLOT_BITS-1:0];
  wire [SLOT_BITS-1:0] first_place = second_place + SLOT_BITS'(second_push_i);
`else
  wire [SLOT_BITS-1:0] first_place = tail_q[SLOT_BITS-1:0];
  wire [SLOT_BITS-1:0] second_place = first_place + SLOT_BITS'(first_push_i);
`endif

  assign valid_o = head_q != tail_q;
  assign slot_o = ring_q[head_q[SLOT_BITS-1:0]];

  always_ff @(posedge clk_i) begin
    if (first_push_i) ring_q[first_place] <= first_slot_i;
    if (second_push_i) ring_q[second_place] <= second_slot_i;
  end

  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      head_q <= '0;
      tail_q <= '0;
    end else begin
      head_q <= head_q + (SLOT_BITS + 1)'(pop_i);
      tail_q <= tail_q + (SLOT_BITS + 1)'(first_push_i) + (SLOT_BITS + 1)'(second_push_i);
    end
  end
endmodule
