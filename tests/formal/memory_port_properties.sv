// What memory_port promises as an arbiter (rtl/memory_port.sv), for any clients and any memory: one grant at most, to
// a client that asks and that memory can take, and always one where there is such a client; who keeps asking and can
// be taken is granted before CLIENTS others are; requests and answers go through unchanged, answers only to their
// client.
`include "tokens.svh"

module memory_port_properties #(
    parameter int CLIENTS = 4,
    localparam int ADDRESS_BITS = 3,
    localparam int REQUEST_BITS = ADDRESS_BITS + `CTU_ID_BITS + 1
) (
    input logic                            clk_i,
    input logic                            rst_i,
    input logic [             CLIENTS-1:0] requests_valid_i,
    input logic [CLIENTS*REQUEST_BITS-1:0] requests_data_i,
    input logic [             CLIENTS-1:0] answers_ready_i,
    input logic [             CLIENTS-1:0] mem_accepts_i,
    input logic                            mem_answer_valid_i,
    input logic [                     1:0] mem_answer_client_i,
    input logic [                    15:0] mem_answer_data_i,
    input logic [                     1:0] client_i             // any client
);
  logic [CLIENTS-1:0] pop, push;
  logic request, take;
  logic [1:0] request_client;
  logic [REQUEST_BITS-1:0] request_data;
  logic [15:0] answer_data;
  memory_port #(
      .CLIENTS(CLIENTS),
      .ADDRESS_BITS(ADDRESS_BITS),
      .LINE_BYTES(1)
  ) dut (
      .clk_i,
      .rst_i,
      .requests_valid_i,
      .requests_data_i,
      .write_data_i(8'd0),
      .requests_pop_o(pop),
      .answers_ready_i,
      .answers_push_o(push),
      .answers_data_o(answer_data),
      .activity_o(),
      .mem_address_o(),
      .mem_accepts_i,
      .mem_request_o(request),
      .mem_request_client_o(request_client),
      .mem_request_data_o(request_data),
      .mem_write_data_o(),
      .mem_answer_valid_i,
      .mem_answer_client_i,
      .mem_answer_data_i,
      .mem_answer_take_o(take),
      .mem_busy_i(1'b0)
  );

  // Others that were granted since the client has been asking, and could have been taken, without a break.
  logic started_q = 1'b0;
  logic [2:0] others_q;
  logic [1:0] client_q;
  wire [CLIENTS-1:0] able = requests_valid_i & mem_accepts_i;
  wire wants = able[client_i];
  always_ff @(posedge clk_i) begin
    started_q <= 1'b1;
    client_q <= client_i;
    others_q <= rst_i || !wants || pop[client_i] ? 3'd0 : others_q + 3'(request);
  end
  always_comb begin
    assume (started_q || rst_i);
    assume (32'(client_i) < CLIENTS && (!started_q || client_i == client_q));
    assume (32'(mem_answer_client_i) < CLIENTS);
  end

  always_comb begin
    if (started_q) begin
      one_hot : assert ((pop & (pop - 1'b1)) == '0);
      only_able : assert ((pop & ~able) == '0);
      always_one : assert (request == (able != '0) && request == (pop != '0));
      named : assert (!pop[client_i] || (request_client == client_i &&
                      request_data == requests_data_i[REQUEST_BITS*32'(client_i)+:REQUEST_BITS]));
      fair : assert (32'(others_q) + 32'(wants && request && !pop[client_i]) < CLIENTS);
      answers : assert (push[client_i] == (mem_answer_valid_i && mem_answer_client_i == client_i &&
                                           answers_ready_i[client_i]));
      taken : assert (take == (push != '0) && answer_data == mem_answer_data_i);
      waits_longest : cover (32'(others_q) == CLIENTS - 1 && pop[client_i]);
      blocked : cover (mem_answer_valid_i && !take && pop[client_i]);
    end
  end

`ifdef CTU_INVARIANTS
  // The register inside, under the name that it has after flattening; turns go round all 4 numbers.
  (* hierconn *) wire [1:0] \dut.turn_q ;
  wire [1:0] until_turn = client_i - \dut.turn_q ;
  logic [2:0] turns;  // of clients before it
  always_comb begin
    turns = 3'd0;
    for (int n = 0; n < 3; n++)
      if (n < 32'(until_turn) && 32'(2'(\dut.turn_q + 2'(n))) < CLIENTS) turns = turns + 3'd1;
    if (started_q) approaches : assert (32'(others_q) + 32'(turns) < CLIENTS);
  end
`endif
endmodule
