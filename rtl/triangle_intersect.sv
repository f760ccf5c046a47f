// triangle_intersect: one ray against one triangle, watertight: the arithmetic of triangle_test.
//
//   latency LATENCY, at least 1; initiation interval 1; enable_i stops all registers
//   twin    ctu::intersect::triangle_test (model/intersect/triangle_test.h), whose header states every rounding
//
// Between its operands and the quotients numbers are wide ones (rtl/float/wide_format.svh). LATENCY is spread over the
// steps in proportion to where they end at LATENCY 45:
//
//   translate  v - origin                                          4
//   shear      product 8, difference                              12
//   edges      the three edge functions                           20
//   determinant  U + V 23, + W 26, times the direction            28
//   depth      products 22, sum of two 25, of three               28
//   divide     t, u, v                                            44
//   range      tmin <= t <= tmax, and the signs of the edges      45
//
// The unit of each step spreads its share over its own steps.
`include "wide_format.svh"

module triangle_intersect #(
    parameter int LATENCY = 45
) (
    input  logic         clk_i,
    input  logic         enable_i,
    input  logic [ 95:0] origin_i,       // x in the lowest bits, also of the vertices
    input  logic [ 31:0] direction_z_i,  // the component along kz
    input  logic [  1:0] kx_i,           // the permutation of axes
    input  logic [  1:0] ky_i,
    input  logic [  1:0] kz_i,
    input  logic [ 31:0] sx_i,           // the shear
    input  logic [ 31:0] sy_i,
    input  logic [ 31:0] tmin_i,
    input  logic [ 31:0] tmax_i,
    input  logic [287:0] vertices_i,     // v0 in the lowest bits
    output logic         hit_o,
    output logic [ 31:0] t_o,            // these three +0 without a hit
    output logic [ 31:0] u_o,
    output logic [ 31:0] v_o
);
  // The last register of each step, counted from the entrance.
  localparam int TRANSLATED = 4 * LATENCY / 45;
  localparam int SCALED = 8 * LATENCY / 45;
  localparam int SHEARED = 12 * LATENCY / 45;
  localparam int EDGES = 20 * LATENCY / 45;
  localparam int DEPTHS = 22 * LATENCY / 45;
  localparam int TWO_EDGES = 23 * LATENCY / 45;
  localparam int TWO_DEPTHS = 25 * LATENCY / 45;
  localparam int DETERMINANT = 26 * LATENCY / 45;
  localparam int RATIOS = 28 * LATENCY / 45;
  localparam int DIVIDED = 44 * LATENCY / 45;

  // Translate and shear: each vertex in the ray's space, x and y sheared, z the distance along kz.
  logic [`WIDE_BITS-1:0] sx, sy, sx_q, sy_q;
  wide_from_float convert_sx (
      .value_i (sx_i),
      .result_o(sx)
  );
  wide_from_float convert_sy (
      .value_i (sy_i),
      .result_o(sy)
  );
  pipe_row #(
      .WIDTH(2 * `WIDE_BITS),
      .DEPTH(TRANSLATED)
  ) row_shear (
      .clk_i,
      .enable_i,
      .data_i({sx, sy}),
      .data_o({sx_q, sy_q})
  );

  logic [3*`WIDE_BITS-1:0] x, y, z;  // of the three vertices
  generate
    for (genvar vertex = 0; vertex < 3; vertex++) begin : g_vertex
      wire [95:0] position = vertices_i[96*vertex+:96];
      logic [3*`WIDE_BITS-1:0] distances;  // along kx, ky, kz
      for (genvar place = 0; place < 3; place++) begin : g_axis
        wire [1:0] axis = place == 0 ? kx_i : place == 1 ? ky_i : kz_i;
        wire [31:0] to = axis == 2'd0 ? position[31:0] : axis == 2'd1 ? position[63:32] : position[95:64];
        wire [31:0] from = axis == 2'd0 ? origin_i[31:0] : axis == 2'd1 ? origin_i[63:32] : origin_i[95:64];
        logic [`WIDE_BITS-1:0] wide_to, wide_from;
        wide_from_float #(
            .NORMALISE(1'b0)
        ) convert_to (
            .value_i (to),
            .result_o(wide_to)
        );
        wide_from_float #(
            .NORMALISE(1'b0)
        ) convert_from (
            .value_i (from),
            .result_o(wide_from)
        );
        wide_add #(
            .LATENCY(TRANSLATED)
        ) translate (
            .clk_i,
            .enable_i,
            .a_i(wide_to),
            .b_i(wide_from),
            .subtract_i(1'b1),
            .result_o(distances[`WIDE_BITS*place+:`WIDE_BITS])
        );
      end

      wire [`WIDE_BITS-1:0] along = distances[2*`WIDE_BITS+:`WIDE_BITS];
      logic [2*`WIDE_BITS-1:0] across, sheared;
      pipe_row #(
          .WIDTH(2 * `WIDE_BITS),
          .DEPTH(SCALED - TRANSLATED)
      ) row_across (
          .clk_i,
          .enable_i,
          .data_i(distances[2*`WIDE_BITS-1:0]),
          .data_o(across)
      );
      for (genvar place = 0; place < 2; place++) begin : g_shear
        logic [`WIDE_BITS-1:0] scaled;
        wide_mul #(
            .LATENCY(SCALED - TRANSLATED)
        ) scale (
            .clk_i,
            .enable_i,
            .a_i(place == 0 ? sx_q : sy_q),
            .b_i(along),
            .result_o(scaled)
        );
        wide_add #(
            .LATENCY(SHEARED - SCALED)
        ) shear (
            .clk_i,
            .enable_i,
            .a_i(across[`WIDE_BITS*place+:`WIDE_BITS]),
            .b_i(scaled),
            .subtract_i(1'b1),
            .result_o(sheared[`WIDE_BITS*place+:`WIDE_BITS])
        );
      end
      assign x[`WIDE_BITS*vertex+:`WIDE_BITS] = sheared[`WIDE_BITS-1:0];
      assign y[`WIDE_BITS*vertex+:`WIDE_BITS] = sheared[2*`WIDE_BITS-1:`WIDE_BITS];
      // z is needed again where the edge functions are known.
      pipe_row #(
          .WIDTH(`WIDE_BITS),
          .DEPTH(EDGES - TRANSLATED)
      ) row_z (
          .clk_i,
          .enable_i,
          .data_i(along),
          .data_o(z[`WIDE_BITS*vertex+:`WIDE_BITS])
      );
    end
  endgenerate

  // Edge functions: of each vertex the area opposite to it, between the next but one and the next: U = cx by - cy bx,
  // V = ax cy - ay cx, W = bx ay - by ax.
  logic [3*`WIDE_BITS-1:0] edges;
  logic [2:0] negative, positive;
  generate
    for (genvar vertex = 0; vertex < 3; vertex++) begin : g_edge
      localparam int NEXT = (vertex + 1) % 3;
      localparam int LAST = (vertex + 2) % 3;
      wide_difference #(
          .LATENCY(EDGES - SHEARED)
      ) area (
          .clk_i,
          .enable_i,
          .a_i(x[`WIDE_BITS*LAST+:`WIDE_BITS]),
          .b_i(y[`WIDE_BITS*NEXT+:`WIDE_BITS]),
          .c_i(y[`WIDE_BITS*LAST+:`WIDE_BITS]),
          .d_i(x[`WIDE_BITS*NEXT+:`WIDE_BITS]),
          .result_o(edges[`WIDE_BITS*vertex+:`WIDE_BITS])
      );
      wire not_zero = edges[`WIDE_BITS*vertex+`WIDE_NOT_ZERO];
      assign negative[vertex] = not_zero && edges[`WIDE_BITS*vertex+`WIDE_SIGN];
      assign positive[vertex] = not_zero && !edges[`WIDE_BITS*vertex+`WIDE_SIGN];
    end
  endgenerate

  // Signs that disagree miss; all zero is a triangle seen edge-on, and the only one without a determinant.
  logic agree, agree_q;
`ifdef CTU_MUTATE_EDGE_SIGN_OF_ZERO
  assign agree = (negative == 3'd0 && positive != 3'd0) || negative == 3'd7;
`elsif CTU_MUTATE_EDGE_ON_HIT
  assign agree = negative == 3'd0 || positive == 3'd0;
`else
  assign agree = (negative == 3'd0) != (positive == 3'd0);
`endif
  pipe_row #(
      .WIDTH(1),
      .DEPTH(DIVIDED - EDGES)
  ) row_agree (
      .clk_i,
      .enable_i,
      .data_i(agree),
      .data_o(agree_q)
  );

  // The determinant, and the denominator of t.
  logic [`WIDE_BITS-1:0] edge_w_q, two_edges, determinant, determinant_q, denominator, direction, direction_q;
  wide_add #(
      .LATENCY(TWO_EDGES - EDGES)
  ) add_two_edges (
      .clk_i,
      .enable_i,
      .a_i(edges[`WIDE_BITS-1:0]),
      .b_i(edges[2*`WIDE_BITS-1:`WIDE_BITS]),
      .subtract_i(1'b0),
      .result_o(two_edges)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(TWO_EDGES - EDGES)
  ) row_edge_w (
      .clk_i,
      .enable_i,
      .data_i(edges[3*`WIDE_BITS-1:2*`WIDE_BITS]),
      .data_o(edge_w_q)
  );
  wide_add #(
      .LATENCY(DETERMINANT - TWO_EDGES)
  ) add_third_edge (
      .clk_i,
      .enable_i,
      .a_i(two_edges),
      .b_i(edge_w_q),
      .subtract_i(1'b0),
      .result_o(determinant)
  );
  wide_from_float convert_direction (
      .value_i (direction_z_i),
      .result_o(direction)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(DETERMINANT)
  ) row_direction (
      .clk_i,
      .enable_i,
      .data_i(direction),
      .data_o(direction_q)
  );
  wide_mul #(
      .LATENCY(RATIOS - DETERMINANT)
  ) scale_determinant (
      .clk_i,
      .enable_i,
      .a_i(determinant),
      .b_i(direction_q),
      .result_o(denominator)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(RATIOS - DETERMINANT)
  ) row_determinant (
      .clk_i,
      .enable_i,
      .data_i(determinant),
      .data_o(determinant_q)
  );

  // The depth, and what u and v are of.
  logic [3*`WIDE_BITS-1:0] depths;
  logic [`WIDE_BITS-1:0] depth_w_q, two_depths, depth;
  logic [2*`WIDE_BITS-1:0] edges_q;
  generate
    for (genvar vertex = 0; vertex < 3; vertex++) begin : g_depth
      wide_mul #(
          .LATENCY(DEPTHS - EDGES)
      ) weigh (
          .clk_i,
          .enable_i,
          .a_i(edges[`WIDE_BITS*vertex+:`WIDE_BITS]),
          .b_i(z[`WIDE_BITS*vertex+:`WIDE_BITS]),
          .result_o(depths[`WIDE_BITS*vertex+:`WIDE_BITS])
      );
    end
  endgenerate
  wide_add #(
      .LATENCY(TWO_DEPTHS - DEPTHS)
  ) add_two_depths (
      .clk_i,
      .enable_i,
      .a_i(depths[`WIDE_BITS-1:0]),
      .b_i(depths[2*`WIDE_BITS-1:`WIDE_BITS]),
      .subtract_i(1'b0),
      .result_o(two_depths)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(TWO_DEPTHS - DEPTHS)
  ) row_depth_w (
      .clk_i,
      .enable_i,
      .data_i(depths[3*`WIDE_BITS-1:2*`WIDE_BITS]),
      .data_o(depth_w_q)
  );
  wide_add #(
      .LATENCY(RATIOS - TWO_DEPTHS)
  ) add_third_depth (
      .clk_i,
      .enable_i,
      .a_i(two_depths),
      .b_i(depth_w_q),
      .subtract_i(1'b0),
      .result_o(depth)
  );
  pipe_row #(
      .WIDTH(2 * `WIDE_BITS),
      .DEPTH(RATIOS - EDGES)
  ) row_edges (
      .clk_i,
      .enable_i,
      .data_i(edges[3*`WIDE_BITS-1:`WIDE_BITS]),
      .data_o(edges_q)
  );

  // Divide.
  logic [31:0] t, u, v;
  wide_div #(
      .LATENCY(DIVIDED - RATIOS)
  ) divide_t (
      .clk_i,
      .enable_i,
      .a_i(depth),
      .b_i(denominator),
      .result_o(t)
  );
  wide_div #(
      .LATENCY(DIVIDED - RATIOS)
  ) divide_u (
      .clk_i,
      .enable_i,
      .a_i(edges_q[`WIDE_BITS-1:0]),
      .b_i(determinant_q),
      .result_o(u)
  );
  wide_div #(
      .LATENCY(DIVIDED - RATIOS)
  ) divide_v (
      .clk_i,
      .enable_i,
      .a_i(edges_q[2*`WIDE_BITS-1:`WIDE_BITS]),
      .b_i(determinant_q),
      .result_o(v)
  );

  // Range. No operand is a NaN, but a quotient without a determinant is not what the model gives; the signs say so.
  logic [31:0] tmin_q, tmax_q;
  logic too_near, too_far, hit;
  logic [3:0] unused_compare;
  pipe_row #(
      .WIDTH(64),
      .DEPTH(DIVIDED)
  ) row_range (
      .clk_i,
      .enable_i,
      .data_i({tmin_i, tmax_i}),
      .data_o({tmin_q, tmax_q})
  );
  float_compare compare_tmin (
      .a_i(t),
      .b_i(tmin_q),
      .less_o(too_near),
      .equal_o(unused_compare[0]),
      .unordered_o(unused_compare[1])
  );
  float_compare compare_tmax (
      .a_i(tmax_q),
      .b_i(t),
      .less_o(too_far),
      .equal_o(unused_compare[2]),
      .unordered_o(unused_compare[3])
  );
`ifdef CTU_MUTATE_TRIANGLE_RANGE_OPEN
  assign hit = agree_q && !too_near && !too_far && !unused_compare[0] && !unused_compare[2];
`else
  assign hit = agree_q && !too_near && !too_far;
`endif
  pipe_row #(
      .WIDTH(97),
      .DEPTH(LATENCY - DIVIDED)
  ) row_result (
      .clk_i,
      .enable_i,
      .data_i({hit, hit ? {t, u, v} : 96'd0}),
      .data_o({hit_o, t_o, u_o, v_o})
  );
endmodule
