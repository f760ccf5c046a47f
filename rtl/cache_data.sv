// cache_data: the lines that a cache holds.
//
//   latency 1: the line asked for in cycle t stands at data_o in t + 1; a line written in t is there for reads of t + 1
//   twin    none: the model keeps no bytes in its caches
module cache_data #(
    parameter int LINE_BITS = 256,
    parameter int PORTS = 1,
    parameter int SETS = 2,
    parameter int WAYS = 2,
    localparam int SET_BITS = SETS == 1 ? 1 : $clog2(SETS),
    localparam int WAY_BITS = WAYS == 1 ? 1 : $clog2(WAYS)
) (
    input  logic                      clk_i,
    input  logic [PORTS*SET_BITS-1:0] set_i,
    input  logic [PORTS*WAY_BITS-1:0] way_i,
    input  logic [         PORTS-1:0] read_i,
    output logic [PORTS*LINE_BITS-1:0] data_o,
    input  logic                      write_i,
    input  logic [      SET_BITS-1:0] write_set_i,
    input  logic [      WAY_BITS-1:0] write_way_i,
    input  logic [     LINE_BITS-1:0] write_data_i
);
  logic [LINE_BITS-1:0] lines_q[1<<(SET_BITS+WAY_BITS)];

  always_ff @(posedge clk_i) if (write_i) lines_q[{write_set_i, write_way_i}] <= write_data_i;

  generate
    for (genvar p = 0; p < PORTS; p++) begin : g_port
      logic [LINE_BITS-1:0] data_q;
      always_ff @(posedge clk_i)
        if (read_i[p]) data_q <= lines_q[{set_i[SET_BITS*p+:SET_BITS], way_i[WAY_BITS*p+:WAY_BITS]}];
      assign data_o[LINE_BITS*p+:LINE_BITS] = data_q;
    end
  endgenerate
endmodule
