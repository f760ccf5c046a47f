// link: the FIFO of two entries between two stages, with registered valid and ready.
//
//   latency 1: what is pushed in cycle t stands at data_o from t + 1 on; the room that a pop makes can be used from
//           t + 1 on. One push and one pop a cycle at most; push_i only with ready_o, pop_i only with valid_o
//   twin    model/pipeline/link.h
//
// stall_push_i and stall_pop_i make it refuse in this cycle whatever it holds: for tests, which show that refusals
// change no answer; tied low in a chip.
module link #(
    parameter int WIDTH = 1
) (
    input  logic             clk_i,
    input  logic             rst_i,
    input  logic             stall_push_i,
    input  logic             stall_pop_i,
    input  logic             push_i,
    input  logic [WIDTH-1:0] data_i,
    output logic             ready_o,
    input  logic             pop_i,
    output logic             valid_o,
    output logic [WIDTH-1:0] data_o
);
  logic [WIDTH-1:0] first_q, second_q;
  logic valid_q, full_q;  // first_q holds an entry; second_q holds one as well

  assign valid_o = valid_q && !stall_pop_i;
  assign ready_o = !full_q && !stall_push_i;
  assign data_o = first_q;

  always_ff @(posedge clk_i) begin
    if (pop_i && full_q) first_q <= second_q;
`ifdef CTU_MUTATE_LINK_PASSED_ENTRY
    else if (push_i && !valid_q) first_q <= data_i;
`else
    else if (push_i && (pop_i || !valid_q)) first_q <= data_i;
`endif
    if (push_i) second_q <= data_i;
  end

  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      valid_q <= 1'b0;
      full_q <= 1'b0;
    end else begin
      valid_q <= push_i || full_q || (valid_q && !pop_i);
      full_q <= !pop_i && (full_q || (valid_q && push_i));
    end
  end
endmodule
