// miss_registers: one register (MSHR) for each line under way from memory, with the contexts that wait for it.
//
//   twin    MissRegisters (model/pipeline/cache.h)
//
// In a cycle either up to PORTS different lines are looked up for one context, of which one at most takes a register,
// the free one with the lowest number; or one register is released.
module miss_registers #(
    parameter int SLOT_BITS = 2,
    parameter int LINE_NUMBER_BITS = 27,
    parameter int PORTS = 1,
    parameter int MAX_MSHRS = 4,
    localparam int NUMBER_BITS = MAX_MSHRS == 1 ? 1 : $clog2(MAX_MSHRS),
    localparam int SLOTS = 1 << SLOT_BITS
) (
    input logic clk_i,
    input logic rst_i,

    // Strap.
    input logic [$clog2(MAX_MSHRS+1)-1:0] mshrs_i,  // in use, at least 1

    input  logic [PORTS*LINE_NUMBER_BITS-1:0] lines_i,
    output logic [                 PORTS-1:0] found_o,         // a register waits for the line
    output logic                              full_o,
    output logic                              last_o,          // one register is free
    output logic                              none_in_use_o,
    output logic [           NUMBER_BITS-1:0] free_o,          // the register to be taken next
    input  logic [                 PORTS-1:0] wait_i,          // the context waits for the port's line
    input  logic [             SLOT_BITS-1:0] wait_slot_i,
    input  logic                              allocate_i,      // the one that waits for a line not found takes free_o
    input  logic [      LINE_NUMBER_BITS-1:0] allocate_line_i,

    input  logic                        release_i,
    input  logic [     NUMBER_BITS-1:0] release_number_i,
    output logic [LINE_NUMBER_BITS-1:0] release_line_o,
    output logic [           SLOTS-1:0] release_waiters_o
);
  logic [MAX_MSHRS-1:0] in_use_q, free;
  (* mem2reg *) logic [LINE_NUMBER_BITS-1:0] lines_q[MAX_MSHRS];
  (* mem2reg *) logic [SLOTS-1:0] waiters_q[MAX_MSHRS];

  assign none_in_use_o = in_use_q == '0;
  assign full_o = free == '0;
  assign last_o = free != '0 && (free & (free - 1'b1)) == '0;
  always_comb begin
    free_o = '0;
    for (int m = MAX_MSHRS - 1; m >= 0; m--) begin
      free[m] = !in_use_q[m] && m < 32'(mshrs_i);
`ifdef CTU_MUTATE_FETCH_HIGHEST_REGISTER
      if (free[m] && (free >> (m + 1)) == '0) free_o = NUMBER_BITS'(m);
`else
      if (free[m]) free_o = NUMBER_BITS'(m);
`endif
    end
  end

  logic [MAX_MSHRS-1:0] joined;  // by the context
  logic [MAX_MSHRS*PORTS-1:0] match;
  always_comb begin
    found_o = '0;
    for (int m = 0; m < MAX_MSHRS; m++) begin
      for (int p = 0; p < PORTS; p++)
        match[PORTS*m+p] = in_use_q[m] && lines_q[m] == lines_i[LINE_NUMBER_BITS*p+:LINE_NUMBER_BITS];
      found_o = found_o | match[PORTS*m+:PORTS];
    end
  end
  always_comb for (int m = 0; m < MAX_MSHRS; m++) joined[m] = (match[PORTS*m+:PORTS] & wait_i) != '0;

  assign release_line_o = lines_q[release_number_i];
  assign release_waiters_o = waiters_q[release_number_i];

  generate
    for (genvar m = 0; m < MAX_MSHRS; m++) begin : g_register
      wire taken = allocate_i && 32'(free_o) == m;
      always_ff @(posedge clk_i) begin
        if (rst_i) in_use_q[m] <= 1'b0;
        else if (taken) in_use_q[m] <= 1'b1;
        else if (release_i && 32'(release_number_i) == m) in_use_q[m] <= 1'b0;
      end
      always_ff @(posedge clk_i) begin
        if (taken) lines_q[m] <= allocate_line_i;
        if (taken) waiters_q[m] <= SLOTS'(1) << wait_slot_i;
        else if (joined[m]) waiters_q[m] <= waiters_q[m] | (SLOTS'(1) << wait_slot_i);
      end
    end
  endgenerate
endmodule
