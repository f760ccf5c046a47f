// table_bank: a bank of a table on chip: rows that a host fills, PORTS reads a cycle.
//
//   latency 1: the row read in cycle t stands at data_o from t + 1 on, until the next read at the same port
//   twin    a bank of TableBanks (model/pipeline/table_banks.h), which counts reads and keeps no rows
//
// What a memory macro takes the place of.
module table_bank #(
    parameter int ROWS = 16,
    parameter int WIDTH = 16,
    parameter int PORTS = 1,
    localparam int ADDRESS_BITS = ROWS > 1 ? $clog2(ROWS) : 1
) (
    input  logic                          clk_i,
    input  logic                          load_valid_i,
    input  logic [      ADDRESS_BITS-1:0] load_address_i,
    input  logic [             WIDTH-1:0] load_data_i,
    input  logic [             PORTS-1:0] read_i,
    input  logic [ADDRESS_BITS*PORTS-1:0] address_i,
    output logic [       WIDTH*PORTS-1:0] data_o
);
  logic [WIDTH-1:0] rows[0:ROWS-1];

  always_ff @(posedge clk_i) if (load_valid_i) rows[load_address_i] <= load_data_i;

  generate
    for (genvar port = 0; port < PORTS; port++) begin : g_port
      logic [WIDTH-1:0] data_q;
      always_ff @(posedge clk_i) if (read_i[port]) data_q <= rows[address_i[ADDRESS_BITS*port+:ADDRESS_BITS]];
      assign data_o[WIDTH*port+:WIDTH] = data_q;
    end
  endgenerate
endmodule
