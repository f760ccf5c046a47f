// What arrival_queue promises (rtl/arrival_queue.sv) while it is never asked to hold more contexts than there are.
//
// A context is marked at any push; it must come out at its own place in the order. As any one can be marked, none is
// lost or doubled.
module arrival_queue_properties #(
    parameter int SLOT_BITS = 2
) (
    input logic                 clk_i,
    input logic                 rst_i,
    input logic                 first_push_i,
    input logic [SLOT_BITS-1:0] first_slot_i,
    input logic                 second_push_i,
    input logic [SLOT_BITS-1:0] second_slot_i,
    input logic                 pop_i,
    input logic                 mark_first_i,   // mark what is pushed
    input logic                 mark_second_i
);
  localparam int COUNT_BITS = SLOT_BITS + 1;
  localparam logic [COUNT_BITS-1:0] ROOM = COUNT_BITS'(1 << SLOT_BITS);

  logic valid;
  logic [SLOT_BITS-1:0] slot;
  arrival_queue #(
      .SLOT_BITS(SLOT_BITS)
  ) dut (
      .clk_i,
      .rst_i,
      .first_push_i,
      .first_slot_i,
      .second_push_i,
      .second_slot_i,
      .pop_i,
      .valid_o(valid),
      .slot_o(slot)
  );

  // Contexts inside; and the marked one: how many are before it.
  logic [COUNT_BITS-1:0] count_q, before_q;
  logic marked_q;
  logic [SLOT_BITS-1:0] mark_q;
  wire marks_first = first_push_i && mark_first_i && !marked_q;
  wire marks_second = second_push_i && mark_second_i && !marked_q && !marks_first;
  wire leaves = marked_q && pop_i && before_q == '0;
  wire [COUNT_BITS-1:0] stay = count_q - COUNT_BITS'(pop_i);
  wire [COUNT_BITS-1:0] both = stay + COUNT_BITS'(first_push_i);

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb begin
    assume (started_q || rst_i);
    assume (!pop_i || valid);
    assume (32'(count_q) + 32'(first_push_i) + 32'(second_push_i) <= 32'(ROOM));
  end

  always_ff @(posedge clk_i) begin
    count_q <= rst_i ? '0 : both + COUNT_BITS'(second_push_i);
    marked_q <= !rst_i && (marks_first || marks_second || (marked_q && !leaves));
    before_q <= marks_first ? stay : marks_second ? both : before_q - COUNT_BITS'(pop_i);
    if (marks_first) mark_q <= first_slot_i;
    else if (marks_second) mark_q <= second_slot_i;
  end

  always_comb begin
    if (started_q) begin
      count : assert (count_q <= ROOM && valid == (count_q != '0));
      order : assert (!leaves || slot == mark_q);
      inside : assert (!marked_q || before_q < count_q);
      filled : cover (leaves && count_q == ROOM);
      waited : cover (marked_q && before_q == ROOM - COUNT_BITS'(1));
      second_of_two : cover (first_push_i && marks_second && pop_i && before_q == COUNT_BITS'(1));
    end
  end

`ifdef CTU_INVARIANTS
  // Registers inside, under the names that they have after flattening.
  (* hierconn *) wire [SLOT_BITS:0] \dut.head_q , \dut.tail_q ;
  (* hierconn *) wire [SLOT_BITS-1:0] \dut.ring_q[0] , \dut.ring_q[1] , \dut.ring_q[2] , \dut.ring_q[3] ;
  wire [4*SLOT_BITS-1:0] ring = {\dut.ring_q[3] , \dut.ring_q[2] , \dut.ring_q[1] , \dut.ring_q[0] };
  wire [SLOT_BITS-1:0] place = SLOT_BITS'(\dut.head_q + before_q);
  always_comb begin
    if (started_q) begin
      ends : assert (COUNT_BITS'(\dut.tail_q - \dut.head_q ) == count_q);
      marked_place : assert (!marked_q || ring[SLOT_BITS*32'(place)+:SLOT_BITS] == mark_q);
    end
  end
`endif
endmodule
