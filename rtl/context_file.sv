// context_file: registers of all contexts, read in the cycle in which a slot is asked for; what is written in a cycle can
// be read from the next one on.
//
//   twin    a member of the contexts' registers (model/pipeline/exec_source.h)
//
// No two writers name the same slot in a cycle: a context is touched by the one stage that holds its token.
module context_file #(
    parameter int WIDTH = 32,
    parameter int SLOT_BITS = 5,
    parameter int WRITES = 1,
    parameter int READS = 1
) (
    input  logic                        clk_i,
    input  logic [          WRITES-1:0] write_i,
    input  logic [WRITES*SLOT_BITS-1:0] write_slot_i,
    input  logic [    WRITES*WIDTH-1:0] write_data_i,
    input  logic [ READS*SLOT_BITS-1:0] read_slot_i,
    output logic [     READS*WIDTH-1:0] read_data_o
);
  logic [WIDTH-1:0] registers_q[1 << SLOT_BITS];

  generate
    for (genvar w = 0; w < WRITES; w++) begin : g_write
      always_ff @(posedge clk_i)
        if (write_i[w]) registers_q[write_slot_i[SLOT_BITS*w+:SLOT_BITS]] <= write_data_i[WIDTH*w+:WIDTH];
    end
    for (genvar r = 0; r < READS; r++) begin : g_read
      assign read_data_o[WIDTH*r+:WIDTH] = registers_q[read_slot_i[SLOT_BITS*r+:SLOT_BITS]];
    end
  endgenerate
endmodule
