// The wide units for each latency from 0 to LONGEST on the same operands, dividers and root for each multiple of
// DIVIDE_STEP up to DIVIDE_STEP * LONGEST; a wide number as binary32; and the difference of two binary32 numbers as the triangle test begins with it.
`include "wide_format.svh"

module wide_bench #(
    parameter int LONGEST = 0,
    parameter int DIVIDE_STEP = 4
) (
    input  logic                  clk_i,
    input  logic                  enable_i,
    input  logic [`WIDE_BITS-1:0] a_i,
    input  logic [`WIDE_BITS-1:0] b_i,
    input  logic [`WIDE_BITS-1:0] c_i,
    input  logic [`WIDE_BITS-1:0] d_i,
    input  logic [          31:0] float_a_i,
    input  logic [          31:0] float_b_i,
    input  logic                  subtract_i,
    output logic [`WIDE_BITS-1:0] converted_o,            // float_a_i
    output logic [`WIDE_BITS-1:0] float_difference_o,     // float_a_i - float_b_i
    output logic [          31:0] narrowed_o,             // a_i
    output logic [`WIDE_BITS-1:0] sum_o       [LONGEST+1],  // a_i + b_i or a_i - b_i
    output logic [`WIDE_BITS-1:0] product_o   [LONGEST+1],  // a_i * b_i
    output logic [`WIDE_BITS-1:0] difference_o[LONGEST+1],  // a_i * b_i - c_i * d_i
    output logic [          31:0] quotient_o  [LONGEST+1],  // a_i / b_i
    output logic [`WIDE_BITS-1:0] ratio_o     [LONGEST+1],  // the same
    output logic [`WIDE_BITS-1:0] root_o      [LONGEST+1]   // of |a_i|
);
  wide_from_float convert (
      .value_i (float_a_i),
      .result_o(converted_o)
  );
  logic [`WIDE_BITS-1:0] wide_a, wide_b;
  wide_from_float #(
      .NORMALISE(1'b0)
  ) convert_a (
      .value_i (float_a_i),
      .result_o(wide_a)
  );
  wide_from_float #(
      .NORMALISE(1'b0)
  ) convert_b (
      .value_i (float_b_i),
      .result_o(wide_b)
  );
  wide_add #(
      .LATENCY(0)
  ) subtract_floats (
      .clk_i,
      .enable_i,
      .a_i(wide_a),
      .b_i(wide_b),
      .subtract_i(1'b1),
      .result_o(float_difference_o)
  );

  wide_to_float narrow (
      .value_i (a_i),
      .result_o(narrowed_o)
  );

  generate
    for (genvar latency = 0; latency <= LONGEST; latency++) begin : g_latency
      wide_add #(
          .LATENCY(latency)
      ) add (
          .clk_i,
          .enable_i,
          .a_i,
          .b_i,
          .subtract_i,
          .result_o(sum_o[latency])
      );
      wide_mul #(
          .LATENCY(latency)
      ) mul (
          .clk_i,
          .enable_i,
          .a_i,
          .b_i,
          .result_o(product_o[latency])
      );
      wide_difference #(
          .LATENCY(latency)
      ) subtract_products (
          .clk_i,
          .enable_i,
          .a_i,
          .b_i,
          .c_i,
          .d_i,
          .result_o(difference_o[latency])
      );
      wide_div #(
          .LATENCY(latency * DIVIDE_STEP)
      ) div (
          .clk_i,
          .enable_i,
          .a_i,
          .b_i,
          .result_o(quotient_o[latency])
      );
      wide_quotient #(
          .LATENCY(latency * DIVIDE_STEP)
      ) divide (
          .clk_i,
          .enable_i,
          .a_i,
          .b_i,
          .result_o(ratio_o[latency])
      );
      wide_sqrt #(
          .LATENCY(latency * DIVIDE_STEP)
      ) take_root (
          .clk_i,
          .enable_i,
          .a_i({1'b0, a_i[`WIDE_SIGN-1:0]}),
          .result_o(root_o[latency])
      );
    end
  endgenerate
endmodule
