// table_turns: at which turn and port of its bank each read of a node is served.
//
//   combinational
//   twin    TableBanks::add and turns (model/pipeline/table_banks.cpp)
//
// Row r lies in bank r mod BANKS, and a bank serves PORTS reads a turn, in the order of the reads. Reads of the same
// row share one.
module table_turns #(
    parameter int READS = 4,
    parameter int ROW_BITS = 8,
    parameter int BANKS = 4,  // a power of two
    parameter int PORTS = 1
) (
    input  logic [         READS-1:0] valid_i,
    input  logic [ROW_BITS*READS-1:0] row_i,
    output logic [       4*READS-1:0] turn_o,
    output logic [       2*READS-1:0] port_o,
    output logic [               3:0] turns_o  // of all, at least 1
);
  localparam logic [1:0] LAST_PORT = 2'(PORTS - 1);

  logic [READS-1:0] first;  // the first one of its row
  always_comb begin
    first = valid_i;
    turn_o = '0;
    port_o = '0;
    turns_o = 4'd1;
    for (int i = 0; i < READS; i++) begin
      for (int j = 0; j < i; j++) begin
`ifdef CTU_MUTATE_UNSHARED_READS
        if (1'b0) begin
`else
        if (first[i] && valid_i[j] && row_i[ROW_BITS*i+:ROW_BITS] == row_i[ROW_BITS*j+:ROW_BITS]) begin
`endif
          first[i] = 1'b0;
          turn_o[4*i+:4] = turn_o[4*j+:4];
          port_o[2*i+:2] = port_o[2*j+:2];
        end else if (first[i] && first[j] &&
                     ((row_i[ROW_BITS*i+:ROW_BITS] ^ row_i[ROW_BITS*j+:ROW_BITS]) & ROW_BITS'(BANKS - 1)) == '0) begin
          turn_o[4*i+:4] = turn_o[4*i+:4] + 4'(port_o[2*i+:2] == LAST_PORT);
          port_o[2*i+:2] = port_o[2*i+:2] == LAST_PORT ? 2'd0 : port_o[2*i+:2] + 2'd1;
        end
      end
      if (valid_i[i] && turn_o[4*i+:4] >= turns_o) turns_o = turn_o[4*i+:4] + 4'd1;
    end
  end
endmodule
