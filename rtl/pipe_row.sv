// pipe_row: registers in a row with one enable; what enters in cycle t stands at the output DEPTH enabled cycles later.
//
//   latency DEPTH (0: a wire), initiation interval 1
//   twin    model/pipeline/pipe.h, which moves whole tokens; valid bits travel in a row of their own, with a reset
//
// Data registers have no reset: nobody looks at them before their valid bit says so.
module pipe_row #(
    parameter int WIDTH = 1,
    parameter int DEPTH = 1
) (
    input  logic             clk_i,
    input  logic             enable_i,
    input  logic [WIDTH-1:0] data_i,
    output logic [WIDTH-1:0] data_o
);
  generate
    if (DEPTH == 0) begin : g_wire
      wire unused_clock = &{1'b0, clk_i, enable_i};
      assign data_o = data_i;
    end else begin : g_row
      logic [WIDTH*DEPTH-1:0] row_q;
      if (DEPTH == 1) begin : g_one
        always_ff @(posedge clk_i) if (enable_i) row_q <= data_i;
      end else begin : g_many
        always_ff @(posedge clk_i) if (enable_i) row_q <= {row_q[WIDTH*(DEPTH-1)-1:0], data_i};
      end
      assign data_o = row_q[WIDTH*DEPTH-1-:WIDTH];
    end
  endgenerate
endmodule
