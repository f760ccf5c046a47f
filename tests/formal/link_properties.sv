// What link promises, for any stages around it that keep its rules (rtl/link.sv).
//
// An entry is marked at any push; it must come out at its own place in the order, with its data. As any entry can be
// the marked one, none is lost, doubled or changed. A second link gets the same inputs, up to any cycle: the outputs
// of that cycle must be equal however the inputs differ, so they are registers'. Stalls may be raised at any time:
// they only hide what is there.
module link_properties (
    input logic       clk_i,
    input logic       rst_i,
    input logic       stall_push_i,
    input logic       stall_pop_i,
    input logic       push_i,
    input logic [3:0] data_i,
    input logic       pop_i,
    input logic       mark_i,       // mark what is pushed
    input logic       twin_push_i,
    input logic [3:0] twin_data_i,
    input logic       twin_pop_i
);
  logic ready, valid, twin_ready, twin_valid;
  logic [3:0] data, twin_data;
  link #(
      .WIDTH(4)
  ) dut (
      .clk_i,
      .rst_i,
      .stall_push_i,
      .stall_pop_i,
      .push_i,
      .data_i,
      .ready_o(ready),
      .pop_i,
      .valid_o(valid),
      .data_o(data)
  );
  link #(
      .WIDTH(4)
  ) twin (
      .clk_i,
      .rst_i,
      .stall_push_i,
      .stall_pop_i,
      .push_i(twin_push_i),
      .data_i(twin_data_i),
      .ready_o(twin_ready),
      .pop_i(twin_pop_i),
      .valid_o(twin_valid),
      .data_o(twin_data)
  );

  logic started_q = 1'b0;
  always_ff @(posedge clk_i) started_q <= 1'b1;
  always_comb begin
    assume (started_q || rst_i);
    assume (!push_i || ready);
    assume (!pop_i || valid);
    assume (!twin_push_i || twin_ready);
    assume (!twin_pop_i || twin_valid);
  end

  // Entries inside; and the marked one: how many are before it.
  logic [1:0] count_q, before_q;
  logic marked_q;
  logic [3:0] mark_q;
  wire marks = push_i && mark_i && !marked_q;
  wire leaves = marked_q && pop_i && before_q == 2'd0;
  logic waits_q;  // an entry was there and was not popped
  logic [3:0] waiting_q;
  logic same_q;  // the twin has had the same inputs
  always_ff @(posedge clk_i) begin
    count_q <= rst_i ? 2'd0 : count_q + 2'(push_i) - 2'(pop_i);
    marked_q <= !rst_i && (marks || (marked_q && !leaves));
    before_q <= marks ? count_q - 2'(pop_i) : before_q - 2'(pop_i);
    if (marks) mark_q <= data_i;
    waits_q <= !rst_i && count_q != 2'd0 && !pop_i;
    waiting_q <= data;
    same_q <= rst_i || (same_q && {push_i, data_i, pop_i} == {twin_push_i, twin_data_i, twin_pop_i});
  end

  always_comb begin
    if (started_q) begin
      count : assert (count_q <= 2'd2 && valid == (count_q != 2'd0 && !stall_pop_i) &&
                      ready == (count_q != 2'd2 && !stall_push_i));
      order : assert (!leaves || data == mark_q);
      inside : assert (!marked_q || before_q < count_q);
      stays : assert (!waits_q || ((valid || stall_pop_i) && data == waiting_q));
      registered : assert (!same_q || (ready == twin_ready && valid == twin_valid &&
                                       (count_q == 2'd0 || data == twin_data)));
      passed : cover (leaves && mark_q == 4'd5);
      filled : cover (!ready && !stall_push_i && marked_q && before_q == 2'd1);
      flows : cover (push_i && pop_i && waits_q);
      differs : cover (same_q && valid && push_i && !twin_push_i);
    end
  end

`ifdef CTU_INVARIANTS
  // Registers inside, under the names that they have after flattening.
  (* hierconn *) wire \dut.valid_q , \dut.full_q , \twin.valid_q , \twin.full_q ;
  (* hierconn *) wire [3:0] \dut.first_q , \dut.second_q , \twin.first_q , \twin.second_q ;
  always_comb begin
    if (started_q) begin
      place : assert (!marked_q || (before_q == 2'd0 ? \dut.first_q : \dut.second_q ) == mark_q);
      twin_counts : assert (!same_q || {\dut.valid_q , \dut.full_q } == {\twin.valid_q , \twin.full_q });
      counts : assert (count_q == 2'(\dut.valid_q ) + 2'(\dut.full_q ));
      twins : assert (!same_q || count_q != 2'd2 || \dut.second_q == \twin.second_q );
    end
  end
`endif
endmodule
