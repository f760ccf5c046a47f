// result_queue: gives finished rays back, one each interval_i cycles, and frees their contexts.
//
//   latency 0 behind its links; from_stack first
//   twin    model/pipeline/result_queue.h
//   stated  docs/unit.md
//
// In the cycle of return_valid_o the best hit of context return_slot_o is the ray's result: the host reads it there,
// since the context may belong to the next ray a cycle later.
`include "tokens.svh"

module result_queue #(
    parameter int SLOT_BITS = 5
) (
    input  logic                 clk_i,
    input  logic                 rst_i,
    input  logic [          9:0] interval_i,          // strap: result.interval, 1 .. 1000
    input  logic                 from_stack_valid_i,
    input  logic [SLOT_BITS-1:0] from_stack_data_i,   // a slot
    output logic                 from_stack_pop_o,
    input  logic                 from_rays_valid_i,
    input  logic [SLOT_BITS-1:0] from_rays_data_i,    // a slot
    output logic                 from_rays_pop_o,
    input  logic                 freed_ready_i,
    output logic                 freed_push_o,
    output logic [SLOT_BITS-1:0] freed_data_o,        // a slot
    output logic                 return_valid_o,      // to the host, which always takes it
    output logic [SLOT_BITS-1:0] return_slot_o,
    output logic [          3:0] activity_o
);
  logic [9:0] rest_q;  // cycles until the next return may be
  logic waiting, returns;

  assign waiting = from_stack_valid_i || from_rays_valid_i;
  assign returns = waiting && rest_q == 10'd0 && freed_ready_i;
`ifdef CTU_MUTATE_RESULT_RAYS_FIRST
  assign from_stack_pop_o = returns && !from_rays_valid_i;
  assign from_rays_pop_o = returns && from_rays_valid_i;
  assign freed_data_o = from_rays_valid_i ? from_rays_data_i : from_stack_data_i;
`else
  assign from_stack_pop_o = returns && from_stack_valid_i;
  assign from_rays_pop_o = returns && !from_stack_valid_i;
  assign freed_data_o = from_stack_valid_i ? from_stack_data_i : from_rays_data_i;
`endif
  assign freed_push_o = returns;
  assign return_valid_o = returns;
  assign return_slot_o = freed_data_o;

  always_ff @(posedge clk_i) begin
    if (rst_i) rest_q <= 10'd0;
`ifdef CTU_MUTATE_RESULT_INTERVAL_LATE
    else if (returns) rest_q <= interval_i;
`else
    else if (returns) rest_q <= interval_i - 10'd1;
`endif
    else if (rest_q != 10'd0) rest_q <= rest_q - 10'd1;
  end

  always_comb begin
    if (!waiting) activity_o = `CTU_IDLE;
    else if (rest_q != 10'd0) activity_o = `CTU_INTERVAL;
    else if (!freed_ready_i) activity_o = `CTU_OUTPUT_FULL;
    else activity_o = `CTU_BUSY;
  end
endmodule
