// memory_port: the unit's one port to memory, an arbiter for its clients; memory itself is outside.
//
//   latency the memory's; 1 request a cycle to memory, 1 answer a cycle from it, ready in cycle t pushed in t
//   twin    model/pipeline/memory_port.h, without the memory behind it (memory_ideal.h, memory_banked.h)
//   stated  docs/unit.md
//
// Clients are numbered as enum Client: node_fetch, leaf_fetch, traversal_stack, table_fetch; CLIENTS is the last one
// that is there, plus 1, and one that is left out never asks. The memory says in the same cycle, of the state it has at
// the start of the cycle: which client's request it could take (its address is at mem_address_o), whether an answer is
// ready, and whether anything is under way in it.
`include "tokens.svh"

module memory_port #(
    parameter int CLIENTS = 3,
    parameter int ADDRESS_BITS = 32,
    parameter int LINE_BYTES = 32,
    localparam int REQUEST_BITS = ADDRESS_BITS + `CTU_ID_BITS + 1,
    localparam int CLIENT_BITS = 2
) (
    input logic clk_i,
    input logic rst_i,

    // Links, the first client in the lowest bits.
    input  logic [             CLIENTS-1:0] requests_valid_i,
    input  logic [CLIENTS*REQUEST_BITS-1:0] requests_data_i,   // {address, id, write}
    input  logic [        8*LINE_BYTES-1:0] write_data_i,      // of the only client that writes, traversal_stack
    output logic [             CLIENTS-1:0] requests_pop_o,
    input  logic [             CLIENTS-1:0] answers_ready_i,
    output logic [             CLIENTS-1:0] answers_push_o,
    output logic [        8*LINE_BYTES+7:0] answers_data_o,    // response, the same for all
    output logic [                     3:0] activity_o,

    // Memory.
    output logic [CLIENTS*ADDRESS_BITS-1:0] mem_address_o,  // of each client's request
    input  logic [             CLIENTS-1:0] mem_accepts_i,  // the client's request could be taken
    output logic                            mem_request_o,  // one is
    output logic [         CLIENT_BITS-1:0] mem_request_client_o,
    output logic [        REQUEST_BITS-1:0] mem_request_data_o,    // {address, id, write}
    output logic [        8*LINE_BYTES-1:0] mem_write_data_o,
    input  logic                            mem_answer_valid_i,
    input  logic [         CLIENT_BITS-1:0] mem_answer_client_i,
    input  logic [        8*LINE_BYTES+7:0] mem_answer_data_i,     // {id, line}
    output logic                            mem_answer_take_o,
    input  logic                            mem_busy_i             // requests or answers are in it
);
  // The answer.
  wire [CLIENTS-1:0] answered = mem_answer_valid_i ? CLIENTS'(1) << mem_answer_client_i : '0;
`ifdef CTU_MUTATE_PORT_PUSHES_UNASKED
  assign answers_push_o = answered;
`else
  assign answers_push_o = answered & answers_ready_i;
`endif
  assign answers_data_o = mem_answer_data_i;
  assign mem_answer_take_o = answers_push_o != '0;

  // The request: the first in turn that memory can take.
`ifdef CTU_MUTATE_PORT_WAITS_FOR_ALL
  wire [CLIENTS-1:0] able = (requests_valid_i & ~mem_accepts_i) == '0 ? requests_valid_i : '0;
`else
  wire [CLIENTS-1:0] able = requests_valid_i & mem_accepts_i;
`endif
  logic [CLIENT_BITS-1:0] turn_q;
  next_in_turn #(
      .PLACE_BITS(CLIENT_BITS)
  ) arbiter (
      .members_i((1 << CLIENT_BITS)'(able)),
      .start_i(turn_q),
      .found_o(mem_request_o),
      .place_o(mem_request_client_o)
  );
  assign requests_pop_o = mem_request_o ? CLIENTS'(1) << mem_request_client_o : '0;
  assign mem_write_data_o = write_data_i;
  always_comb begin
    mem_request_data_o = '0;
    for (int client = 0; client < CLIENTS; client++) begin
      mem_address_o[ADDRESS_BITS*client+:ADDRESS_BITS] =
          requests_data_i[REQUEST_BITS*client+`CTU_ID_BITS+1+:ADDRESS_BITS];
      if (requests_pop_o[client]) mem_request_data_o = requests_data_i[REQUEST_BITS*client+:REQUEST_BITS];
    end
  end
  always_ff @(posedge clk_i) begin
    if (rst_i) turn_q <= '0;
`ifdef CTU_MUTATE_PORT_TURN_STAYS
    else if (mem_request_o) turn_q <= mem_request_client_o;
`else
    else if (mem_request_o) turn_q <= mem_request_client_o + CLIENT_BITS'(1);
`endif
  end

  // The account. Whatever moves in memory without a request was in it at the start of the cycle.
  always_comb begin
    if (mem_answer_valid_i && !mem_answer_take_o) activity_o = `CTU_OUTPUT_FULL;
    else if (!mem_request_o && requests_valid_i != '0) activity_o = `CTU_MEMORY;
    else activity_o = mem_request_o || mem_busy_i ? `CTU_BUSY : `CTU_IDLE;
  end
endmodule
