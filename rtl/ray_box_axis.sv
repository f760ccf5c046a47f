// ray_box_axis: where a part of a ray lies on one axis, enclosed by two bounds: a face each of the box around it.
//
//   latency MULTIPLY_LATENCY + ADD_LATENCY, initiation interval 1; enable_i stops all registers
//   twin    ctu::cull::RayBox (model/cull/ray_box.h)
//
// Arithmetic: lower is o + t d with product and sum rounded down, for the t of the end that lies lower; upper the other
// end's, rounded up. On an axis along which the ray does not move both are o.
`include "float_format.svh"

module ray_box_axis #(
    parameter int MULTIPLY_LATENCY = 4,
    parameter int ADD_LATENCY = 4
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] origin_i,
    input  logic [31:0] direction_i,
    input  logic [31:0] begin_i,      // t
    input  logic [31:0] end_i,        // t, not before begin_i
    output logic [31:0] lower_o,
    output logic [31:0] upper_o
);
  wire still = direction_i[30:0] == 31'd0;
  logic [31:0] origin_q;
  logic still_q, still_sum;
  pipe_row #(
      .WIDTH(33),
      .DEPTH(MULTIPLY_LATENCY)
  ) row_origin (
      .clk_i,
      .enable_i,
      .data_i({still, origin_i}),
      .data_o({still_q, origin_q})
  );
  logic [31:0] origin_sum;
  pipe_row #(
      .WIDTH(33),
      .DEPTH(ADD_LATENCY)
  ) row_still (
      .clk_i,
      .enable_i,
      .data_i({still_q, origin_q}),
      .data_o({still_sum, origin_sum})
  );

  logic [63:0] bounds;
  generate
    for (genvar bound = 0; bound < 2; bound++) begin : g_bound
      localparam bit UP = bound[0];
`ifdef CTU_MUTATE_RAY_BOX_INWARD
      localparam logic [1:0] ROUND = UP ? `FLOAT_ROUND_DOWN : `FLOAT_ROUND_UP;
`else
      localparam logic [1:0] ROUND = UP ? `FLOAT_ROUND_UP : `FLOAT_ROUND_DOWN;
`endif
      logic [31:0] product, sum;
      float_mul #(
          .LATENCY(MULTIPLY_LATENCY)
      ) scale (
          .clk_i,
          .enable_i,
          .a_i(direction_i[31] != UP ? end_i : begin_i),
          .b_i(direction_i),
          .round_i(ROUND),
          .result_o(product)
      );
      float_add #(
          .LATENCY(ADD_LATENCY)
      ) add (
          .clk_i,
          .enable_i,
          .a_i(origin_q),
          .b_i(product),
          .subtract_i(1'b0),
          .round_i(ROUND),
          .result_o(sum)
      );
      assign bounds[32*bound+:32] = still_sum ? origin_sum : sum;
    end
  endgenerate
  assign {upper_o, lower_o} = bounds;
endmodule
