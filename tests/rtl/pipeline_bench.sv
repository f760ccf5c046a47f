// The float units with registers, for each latency from 0 to LONGEST, on the same operands.
module pipeline_bench #(
    parameter int LONGEST = 9
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] a_i,
    input  logic [31:0] b_i,
    input  logic        subtract_i,
    input  logic [ 1:0] round_i,
    output logic [31:0] sum_o     [LONGEST+1],
    output logic [31:0] product_o [LONGEST+1]
);
  generate
    for (genvar latency = 0; latency <= LONGEST; latency++) begin : g_latency
      float_add #(
          .LATENCY(latency)
      ) add (
          .clk_i,
          .enable_i,
          .a_i,
          .b_i,
          .subtract_i,
          .round_i,
          .result_o(sum_o[latency])
      );
      float_mul #(
          .LATENCY(latency)
      ) mul (
          .clk_i,
          .enable_i,
          .a_i,
          .b_i,
          .round_i,
          .result_o(product_o[latency])
      );
    end
  endgenerate
endmodule
