// One float unit many times over, without registers, so that one evaluation of the model answers LANES vectors.
module float_bench #(
    parameter int OPERATION = 0,  // 0 add or, with select_i, subtract; 1 multiply; 2 min or max; 3 compare; 4 divide
    parameter int LANES = 4
) (
    input  logic [31:0] a_i     [LANES],
    input  logic [31:0] b_i     [LANES],
    input  logic        select_i,
    input  logic [ 1:0] round_i,
    output logic [31:0] result_o[LANES]
);
  generate
    for (genvar lane = 0; lane < LANES; lane++) begin : g_lane
      if (OPERATION == 0) begin : g_add
        float_add #(
            .LATENCY(0)
        ) unit (
            .clk_i(1'b0),
            .enable_i(1'b0),
            .a_i(a_i[lane]),
            .b_i(b_i[lane]),
            .subtract_i(select_i),
            .round_i,
            .result_o(result_o[lane])
        );
      end else if (OPERATION == 1) begin : g_mul
        float_mul #(
            .LATENCY(0)
        ) unit (
            .clk_i(1'b0),
            .enable_i(1'b0),
            .a_i(a_i[lane]),
            .b_i(b_i[lane]),
            .round_i,
            .result_o(result_o[lane])
        );
      end else if (OPERATION == 2) begin : g_min_max
        float_min_max unit (
            .a_i(a_i[lane]),
            .b_i(b_i[lane]),
            .max_i(select_i),
            .result_o(result_o[lane])
        );
      end else if (OPERATION == 4) begin : g_div
        logic [31:0] nearest, down, up;
        float_div #(
            .LATENCY(0)
        ) unit (
            .clk_i(1'b0),
            .enable_i(1'b0),
            .a_i(a_i[lane]),
            .b_i(b_i[lane]),
            .nearest_o(nearest),
            .down_o(down),
            .up_o(up)
        );
        assign result_o[lane] = round_i == 2'd0 ? nearest : round_i == 2'd1 ? down : up;
      end else begin : g_compare
        float_compare unit (
            .a_i(a_i[lane]),
            .b_i(b_i[lane]),
            .less_o(result_o[lane][0]),
            .equal_o(result_o[lane][1]),
            .unordered_o(result_o[lane][2])
        );
        assign result_o[lane][31:3] = '0;
      end
    end
  endgenerate
endmodule
