// wide_dot: px qx + py qy + pz qz of wide numbers (wide_format.svh): products rounded, then the sum of the first two, then
// that of all three.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    dot(p, q) of model/intersect/sphere_test.cpp
//
// A third of LATENCY for the products and for each sum.
`include "wide_format.svh"

module wide_dot #(
    parameter int LATENCY = 12
) (
    input  logic                    clk_i,
    input  logic                    enable_i,
    input  logic [3*`WIDE_BITS-1:0] p_i,       // x in the lowest bits
    input  logic [3*`WIDE_BITS-1:0] q_i,
    output logic [  `WIDE_BITS-1:0] result_o
);
  localparam int PRODUCTS = LATENCY / 3;
  localparam int FIRST_SUM = 2 * LATENCY / 3;

  logic [3*`WIDE_BITS-1:0] products;
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_axis
      wide_mul #(
          .LATENCY(PRODUCTS)
      ) multiply (
          .clk_i,
          .enable_i,
          .a_i(p_i[`WIDE_BITS*axis+:`WIDE_BITS]),
          .b_i(q_i[`WIDE_BITS*axis+:`WIDE_BITS]),
          .result_o(products[`WIDE_BITS*axis+:`WIDE_BITS])
      );
    end
  endgenerate

  logic [`WIDE_BITS-1:0] sum_xy, product_z;
  wide_add #(
      .LATENCY(FIRST_SUM - PRODUCTS)
  ) add_y (
      .clk_i,
      .enable_i,
      .a_i(products[`WIDE_BITS-1:0]),
      .b_i(products[2*`WIDE_BITS-1:`WIDE_BITS]),
      .subtract_i(1'b0),
      .result_o(sum_xy)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(FIRST_SUM - PRODUCTS)
  ) row_z (
      .clk_i,
      .enable_i,
      .data_i(products[3*`WIDE_BITS-1:2*`WIDE_BITS]),
      .data_o(product_z)
  );
  wide_add #(
      .LATENCY(LATENCY - FIRST_SUM)
  ) add_z (
      .clk_i,
      .enable_i,
      .a_i(sum_xy),
      .b_i(product_z),
      .subtract_i(1'b0),
      .result_o
  );
endmodule
