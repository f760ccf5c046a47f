// pipe_control: the valid bits and the one enable of a rigid pipeline; its data travel in rows beside it (pipe_row).
//
//   A token that enters in cycle t and keeps the entrance for k cycles leaves in t + k - 1 + LATENCY, and the next one can
//   enter in t + k. When the token in the last register cannot leave, the whole row stands, bubbles included, the
//   cycles at the entrance are not counted, and nothing enters.
//   twin    model/pipeline/pipe.h and pipelined.h
//
// The token is at the first register's input while start_o is set: in the cycle it enters when occupies_i is 1, else in
// the last cycle at the entrance, until when the stage holds what it needs of it. Registers of the data rows move with
// enable_o.
module pipe_control #(
    parameter int LATENCY = 1,
    parameter int OCCUPIES_BITS = 1
) (
    input  logic                     clk_i,
    input  logic                     rst_i,
    input  logic                     enter_i,     // only with can_enter_o
    input  logic [OCCUPIES_BITS-1:0] occupies_i,  // cycles at the entrance, at least 1
    input  logic                     ready_i,     // what leaves can be pushed
    output logic                     can_enter_o,
    output logic                     start_o,
    output logic                     enable_o,
    output logic                     exit_valid_o,  // a token stands in the last register
    output logic                     exit_o,        // and leaves in this cycle
    output logic                     empty_o        // no token inside, the entrance included
);
  logic [LATENCY-1:0] valid_q;
  logic [OCCUPIES_BITS-1:0] rest_q;  // cycles that the token at the entrance still needs it, this one included

  assign exit_valid_o = valid_q[LATENCY-1];
  assign enable_o = !exit_valid_o || ready_i;
  assign exit_o = exit_valid_o && ready_i;
`ifdef CTU_MUTATE_PIPE_ENTERED_WHILE_FROZEN
  assign can_enter_o = rest_q == '0;
`else
  assign can_enter_o = enable_o && rest_q == '0;
`endif
  assign start_o = enable_o && (rest_q == OCCUPIES_BITS'(1) || (enter_i && occupies_i == OCCUPIES_BITS'(1)));
  assign empty_o = valid_q == '0 && rest_q == '0;

  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      valid_q <= '0;
      rest_q <= '0;
    end else if (enable_o) begin
      valid_q <= LATENCY'({valid_q, start_o});
      if (enter_i) rest_q <= occupies_i - OCCUPIES_BITS'(1);
      else if (rest_q != '0) rest_q <= rest_q - OCCUPIES_BITS'(1);
    end
  end
endmodule
