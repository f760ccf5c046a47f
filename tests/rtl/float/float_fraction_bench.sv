// float_fraction of every K and N that planes of a box can have, rounded down and up: K / N at (N-1)(N-2)/2 + K-1.
module float_fraction_bench (
    input  logic [31:0] a_i,
    output logic [31:0] down_o[276],
    output logic [31:0] up_o  [276]
);
  generate
    for (genvar n = 2; n <= 24; n++) begin : g_n
      for (genvar k = 1; k < n; k++) begin : g_k
        for (genvar bound = 0; bound < 2; bound++) begin : g_bound
          logic [31:0] result;
          float_fraction #(
              .K(k),
              .N(n),
              .UP(bound[0]),
              .LATENCY(0)
          ) fraction (
              .clk_i(1'b0),
              .enable_i(1'b0),
              .a_i,
              .result_o(result)
          );
          if (bound == 0) begin : g_down
            assign down_o[(n-1)*(n-2)/2+k-1] = result;
          end else begin : g_up
            assign up_o[(n-1)*(n-2)/2+k-1] = result;
          end
        end
      end
    end
  endgenerate
endmodule
