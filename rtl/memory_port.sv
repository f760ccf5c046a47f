// memory_port: the unit's one port to memory. Node fetch, leaf fetch, the stack's spills and table fetch take turns at it.
//
//   in   requests[client], out answers[client], one vector each, the first client lowest
//   One request a cycle goes to memory, chosen round-robin among the clients whose request memory can take; one answer a
//   cycle comes back, in the order in which memory has them ready. An answer ready in cycle t is pushed in t.
//   twin    model/pipeline/memory_port.h, without the memory behind it
//
// Memory is outside: it sees the address that each client shows (mem_address_o with mem_asked_o) and says in the same
// cycle whose request it can take; its answer stands until it is taken. The account of the port needs to know of memory
// whether it did something by itself in this cycle and whether it is busy behind it.
`include "tokens.svh"

module memory_port #(
    parameter int CLIENTS = 3,        // 2 .. 4: the last one that is there, and those before it
    parameter int ADDRESS_BITS = 40,
    parameter int LINE_BYTES = 128,
    localparam int REQUEST = ADDRESS_BITS + `CTU_ID_BITS + 1  // without data
) (
    input  logic                                 clk_i,
    input  logic                                 rst_i,
    input  logic [                  CLIENTS-1:0] requests_valid_i,
    input  logic [          CLIENTS*REQUEST-1:0] requests_data_i,
    output logic [                  CLIENTS-1:0] requests_pop_o,
    input  logic [                  CLIENTS-1:0] answers_ready_i,
    output logic [                  CLIENTS-1:0] answers_push_o,
    output logic [`CTU_ID_BITS+8*LINE_BYTES-1:0] answers_data_o,        // for the one that is pushed
    // memory
    output logic [                  CLIENTS-1:0] mem_asked_o,
    output logic [     CLIENTS*ADDRESS_BITS-1:0] mem_address_o,
    input  logic [                  CLIENTS-1:0] mem_can_accept_i,
    output logic                                 mem_request_valid_o,
    output logic [                          1:0] mem_request_client_o,
    output logic [             ADDRESS_BITS-1:0] mem_request_address_o,
    output logic [             `CTU_ID_BITS-1:0] mem_request_id_o,
    output logic                                 mem_request_write_o,
    input  logic                                 mem_answer_valid_i,
    input  logic [                          1:0] mem_answer_client_i,
    input  logic [             `CTU_ID_BITS-1:0] mem_answer_id_i,
    input  logic [             8*LINE_BYTES-1:0] mem_answer_data_i,
    output logic                                 mem_answer_take_o,
    input  logic                                 mem_moved_i,
    input  logic                                 mem_busy_i,
    output logic [                          3:0] activity_o
);
  // Requests: the first client from turn_q on, going round, whose request memory takes.
  logic [1:0] turn_q;
  logic [CLIENTS-1:0] takeable, grant;
  logic [1:0] granted;
  logic refused;
  assign mem_asked_o = requests_valid_i;
  assign takeable = requests_valid_i & mem_can_accept_i;
  always_comb begin
    granted = 2'd0;
    for (int client = CLIENTS - 1; client >= 0; client--)
      if (takeable[client] && client < 32'(turn_q)) granted = 2'(client);
    for (int client = CLIENTS - 1; client >= 0; client--)
      if (takeable[client] && client >= 32'(turn_q)) granted = 2'(client);
    for (int client = 0; client < CLIENTS; client++) grant[client] = takeable[client] && granted == 2'(client);
    refused = requests_valid_i != '0 && takeable == '0;
  end
  assign requests_pop_o = grant;
  assign mem_request_valid_o = takeable != '0;
  assign mem_request_client_o = granted;

  always_ff @(posedge clk_i) begin
    if (rst_i) turn_q <= 2'd0;
    else if (mem_request_valid_o) turn_q <= granted == 2'(CLIENTS - 1) ? 2'd0 : granted + 2'd1;
  end

  logic [REQUEST-1:0] request;
  always_comb begin
    request = '0;
    for (int client = 0; client < CLIENTS; client++) begin
      mem_address_o[ADDRESS_BITS*client+:ADDRESS_BITS] =
          requests_data_i[REQUEST*client+1+`CTU_ID_BITS+:ADDRESS_BITS];
      if (grant[client]) request = requests_data_i[REQUEST*client+:REQUEST];
    end
  end
  assign {mem_request_address_o, mem_request_id_o, mem_request_write_o} = request;

  // Answers.
  logic answer_blocked;
  always_comb begin
    for (int client = 0; client < CLIENTS; client++)
      answers_push_o[client] = mem_answer_valid_i && mem_answer_client_i == 2'(client) && answers_ready_i[client];
  end
  assign mem_answer_take_o = answers_push_o != '0;
  assign answer_blocked = mem_answer_valid_i && !mem_answer_take_o;
  assign answers_data_o = {mem_answer_id_i, mem_answer_data_i};

  always_comb begin
    if (answer_blocked) activity_o = `CTU_OUTPUT_FULL;
    else if (refused) activity_o = `CTU_MEMORY;
    else if (mem_answer_take_o || mem_request_valid_o || mem_moved_i || mem_busy_i) activity_o = `CTU_BUSY;
    else activity_o = `CTU_IDLE;
  end
endmodule
