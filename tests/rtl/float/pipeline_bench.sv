// The float units with registers, for each latency from 0 to LONGEST, on the same operands; the divider for each multiple
// of DIVIDE_STEP up to DIVIDE_STEP * LONGEST.
module pipeline_bench #(
    parameter int LONGEST = 9,
    parameter int DIVIDE_STEP = 4
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] a_i,
    input  logic [31:0] b_i,
    input  logic        subtract_i,
    input  logic [ 1:0] round_i,
    output logic [31:0] sum_o     [LONGEST+1],
    output logic [31:0] product_o [LONGEST+1],
    output logic [31:0] quotient_o[LONGEST+1]
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
      logic [31:0] nearest, down, up;
      float_div #(
          .LATENCY(latency * DIVIDE_STEP)
      ) div (
          .clk_i,
          .enable_i,
          .a_i,
          .b_i,
          .nearest_o(nearest),
          .down_o(down),
          .up_o(up)
      );
      // All three in one word, so that none of them can be late.
      assign quotient_o[latency] = nearest ^ {down[30:0], down[31]} ^ {up[29:0], up[31:30]};
    end
  endgenerate
endmodule
