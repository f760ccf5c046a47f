// What pipe_control promises (rtl/pipe_control.sv), with a pipe_row beside it as stages have it.
//
// due_q is the rule in one vector: bit n is a token that leaves n enabled cycles from now. One that enters and keeps
// the entrance for k cycles sets bit LATENCY + k - 2 of the next cycle; an enabled cycle moves all down by one; the
// one at bit 0 leaves when it is taken, and while it is not, all stand. A token's bit lies above all others when it is
// set, so they leave once each, in order.
module pipe_control_properties #(
    parameter int LATENCY = 3,
    parameter int OCCUPIES_BITS = 2
) (
    input logic                     clk_i,
    input logic                     rst_i,
    input logic                     enter_i,
    input logic [OCCUPIES_BITS-1:0] occupies_i,
    input logic                     ready_i,
    input logic [              3:0] data_i,      // of the token that enters
    input logic                     mark_i       // mark it
);
  localparam int AHEAD = LATENCY + (1 << OCCUPIES_BITS) - 1;  // more than any token can be due

  logic can_enter, start, enable, exit_valid, exits, empty;
  logic [3:0] held_q, row_data;
  pipe_control #(
      .LATENCY(LATENCY),
      .OCCUPIES_BITS(OCCUPIES_BITS)
  ) dut (
      .clk_i,
      .rst_i,
      .enter_i,
      .occupies_i,
      .ready_i,
      .can_enter_o(can_enter),
      .start_o(start),
      .enable_o(enable),
      .exit_valid_o(exit_valid),
      .exit_o(exits),
      .empty_o(empty)
  );
  pipe_row #(
      .WIDTH(4),
      .DEPTH(LATENCY)
  ) row (
      .clk_i,
      .enable_i(enable),
      .data_i(enter_i ? data_i : held_q),
      .data_o(row_data)
  );

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb begin
    assume (started_q || rst_i);
    assume (!enter_i || can_enter);
    assume (occupies_i != '0);
  end

  logic [AHEAD-1:0] due_q;
  wire [AHEAD-1:0] entered = enter_i ? AHEAD'(1) << (32'(occupies_i) + LATENCY - 2) : '0;
  wire frozen = due_q[0] && !ready_i;
  wire [AHEAD-1:0] moved = due_q >> 1;

  // The marked token: its data, and enabled cycles since the one in which it entered.
  logic marked_q;
  logic [3:0] mark_q;
  logic [OCCUPIES_BITS-1:0] mark_occupies_q;
  logic [7:0] age_q;
  wire marks = enter_i && mark_i && !marked_q;
  wire [7:0] life = 8'(mark_occupies_q) + 8'(LATENCY) - 8'd1;
  wire leaves = marked_q && exits && age_q == life;
  always_ff @(posedge clk_i) begin
    if (rst_i) due_q <= '0;
    else if (!frozen) due_q <= moved | entered;
    if (enter_i) held_q <= data_i;
    marked_q <= !rst_i && (marks || (marked_q && !leaves));
    if (marks) begin
      mark_q <= data_i;
      mark_occupies_q <= occupies_i;
      age_q <= 8'd1;
    end else if (enable) begin
      age_q <= age_q + 8'd1;
    end
  end

  always_comb begin
    if (started_q) begin
      leaves_when_due : assert (exit_valid == due_q[0] && exits == (due_q[0] && ready_i));
      stands : assert (enable == !frozen);
      entrance : assert (can_enter == (!frozen && (due_q >> LATENCY) == '0));
      starts : assert (start == (!frozen && (due_q[LATENCY] || (enter_i && occupies_i == OCCUPIES_BITS'(1)))));
      behind_all : assert (entered == '0 || moved < entered);
      none_inside : assert (empty == (due_q == '0));
      in_time : assert (!marked_q || age_q <= life);
      data : assert (!leaves || row_data == mark_q);
      passed : cover (leaves && mark_occupies_q == '1);
      follows : cover (leaves && due_q[LATENCY-1] && enter_i);
      holds : cover (marked_q && frozen && age_q == life);
    end
  end

`ifdef CTU_INVARIANTS
  // Registers inside, under the names that they have after flattening.
  (* hierconn *) wire [LATENCY-1:0] \dut.valid_q ;
  (* hierconn *) wire [OCCUPIES_BITS-1:0] \dut.rest_q ;
  (* hierconn *) wire [4*LATENCY-1:0] \row.g_row.row_q ;
  logic [LATENCY-1:0] positions;
  logic [7:0] left;  // enabled cycles until the marked token leaves
  logic row_holds;
  always_comb begin
    row_holds = 1'b0;
    left = life - age_q;
    for (int n = 0; n < LATENCY; n++) begin
      positions[LATENCY-1-n] = due_q[n];
      if (left == 8'(n)) row_holds = \row.g_row.row_q [4*(LATENCY-1-n)+:4] == mark_q;
    end
    if (left >= 8'(LATENCY)) row_holds = held_q == mark_q;
    if (started_q) begin
      valid_bits : assert (\dut.valid_q == positions);
      rest : assert (due_q >> LATENCY == (\dut.rest_q == '0 ? '0 : AHEAD'(1) << (\dut.rest_q - 1'b1)));
      place : assert (!marked_q || (left < 8'(AHEAD) && due_q[left] && row_holds && mark_occupies_q != '0));
    end
  end
`endif
endmodule
