// table_memory: one memory of a mask test's tables, in banks, with the reads that the lanes of a node make at once.
//
//   latency turns_o: the rows of reads that start in cycle t stand at data_o in cycle t + turns_o, and stay until the
//           next start, which can come in that cycle; enable_i stops all of it
//   twin    a memory of TableBanks (model/pipeline/table_banks.h)
//
// Each read is served at a turn and port of its bank (table_turns); the first turn is the cycle of start_i, and what
// later ones read is kept. Rows of an early turn are kept beside the banks until the last one is there.
module table_memory #(
    parameter int ROWS = 256,
    parameter int WIDTH = 16,
    parameter int READS = 4,
    parameter int BANKS = 4,  // a power of two
    parameter int PORTS = 1,
    localparam int ROW_BITS = ROWS > 1 ? $clog2(ROWS) : 1
) (
    input  logic                      clk_i,
    input  logic                      rst_i,
    input  logic                      enable_i,
    input  logic                      load_valid_i,
    input  logic [      ROW_BITS-1:0] load_row_i,
    input  logic [         WIDTH-1:0] load_data_i,
    input  logic                      start_i,       // only with enable_i, and behind the turns of the reads before
    input  logic [         READS-1:0] valid_i,
    input  logic [ROW_BITS*READS-1:0] row_i,
    output logic [               3:0] turns_o,       // that the reads at valid_i take, at least 1
    output logic [   WIDTH*READS-1:0] data_o
);
  localparam int BANK_ROWS = (ROWS + BANKS - 1) / BANKS;
  localparam int ADDRESS_BITS = BANK_ROWS > 1 ? $clog2(BANK_ROWS) : 1;
  localparam int BANK_BITS = $clog2(BANKS);
  localparam int WIDE_BITS = BANK_BITS + ADDRESS_BITS;  // ROW_BITS or, of few rows, more

  logic [WIDE_BITS*READS-1:0] row, row_q;
  logic [4*READS-1:0] turn, turn_q;
  logic [2*READS-1:0] port, port_q;
  logic [READS-1:0] valid_q;
  generate
    for (genvar i = 0; i < READS; i++) begin : g_row
      assign row[WIDE_BITS*i+:WIDE_BITS] = WIDE_BITS'(row_i[ROW_BITS*i+:ROW_BITS]);
    end
  endgenerate
  table_turns #(
      .READS(READS),
      .ROW_BITS(WIDE_BITS),
      .BANKS(BANKS),
      .PORTS(PORTS)
  ) turns (
      .valid_i,
      .row_i(row),
      .turn_o(turn),
      .port_o(port),
      .turns_o
  );

  // Which reads have their turn in this cycle.
  logic [READS-1:0] served;
  logic [3:0] now_q;  // the turn of this cycle; 15: no turn, as twelve reads are the most
  logic [WIDE_BITS*READS-1:0] row_now;
  logic [2*READS-1:0] port_now;
  always_comb begin
    row_now = start_i ? row : row_q;
    port_now = start_i ? port : port_q;
    for (int i = 0; i < READS; i++)
      served[i] = enable_i && (start_i ? valid_i[i] && turn[4*i+:4] == 4'd0 : valid_q[i] && turn_q[4*i+:4] == now_q);
  end
  always_ff @(posedge clk_i) begin
    if (rst_i) now_q <= 4'd15;
    else if (enable_i) now_q <= start_i ? 4'd1 : now_q == 4'd15 ? 4'd15 : now_q + 4'd1;
  end
  always_ff @(posedge clk_i) begin
    if (start_i) begin
      valid_q <= valid_i;
      row_q <= row;
      turn_q <= turn;
      port_q <= port;
    end
  end

  logic [WIDTH*PORTS*BANKS-1:0] bank_data;
  generate
    for (genvar bank = 0; bank < BANKS; bank++) begin : g_bank
      logic [PORTS-1:0] read;
      logic [ADDRESS_BITS*PORTS-1:0] address;
      always_comb begin
        read = '0;
        address = '0;
        for (int i = 0; i < READS; i++) begin
          for (int p = 0; p < PORTS; p++) begin
            if (served[i] && port_now[2*i+:2] == 2'(p) &&
                (row_now[WIDE_BITS*i+:WIDE_BITS] & WIDE_BITS'(BANKS - 1)) == WIDE_BITS'(bank)) begin
              read[p] = 1'b1;
              address[ADDRESS_BITS*p+:ADDRESS_BITS] = row_now[WIDE_BITS*i+BANK_BITS+:ADDRESS_BITS];
            end
          end
        end
      end
      table_bank #(
          .ROWS(BANK_ROWS),
          .WIDTH(WIDTH),
          .PORTS(PORTS)
      ) storage (
          .clk_i,
          .load_valid_i(load_valid_i && (WIDE_BITS'(load_row_i) & WIDE_BITS'(BANKS - 1)) == WIDE_BITS'(bank)),
          .load_address_i(ADDRESS_BITS'(WIDE_BITS'(load_row_i) >> BANK_BITS)),
          .load_data_i,
          .read_i(read),
          .address_i(address),
          .data_o(bank_data[WIDTH*PORTS*bank+:WIDTH*PORTS])
      );
    end

    // What each read has got: at its bank's port, or kept from there in the cycle behind its turn.
    for (genvar i = 0; i < READS; i++) begin : g_read
      logic [WIDTH-1:0] at_port, kept_q;
      logic fresh_q;
      always_comb begin
        at_port = '0;
        for (int bank = 0; bank < BANKS; bank++)
          for (int p = 0; p < PORTS; p++)
            if (port_q[2*i+:2] == 2'(p) && (row_q[WIDE_BITS*i+:WIDE_BITS] & WIDE_BITS'(BANKS - 1)) == WIDE_BITS'(bank))
              at_port = bank_data[WIDTH*(PORTS*bank+p)+:WIDTH];
      end
      always_ff @(posedge clk_i) begin
        if (enable_i) fresh_q <= served[i];
        if (enable_i && fresh_q) kept_q <= at_port;
      end
`ifdef CTU_MUTATE_ROWS_NOT_KEPT
      wire unused_kept = &{1'b0, kept_q};
      assign data_o[WIDTH*i+:WIDTH] = at_port;
`else
      assign data_o[WIDTH*i+:WIDTH] = fresh_q ? at_port : kept_q;
`endif
    end
  endgenerate
endmodule
