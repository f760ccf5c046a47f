// sphere_intersect: one ray against one sphere, from the point of the line nearest to the centre: the arithmetic of
// sphere_test.
//
//   latency LATENCY, at least 1; initiation interval 1; enable_i stops all registers
//   twin    ctu::intersect::sphere_test (model/intersect/sphere_test.h), whose header states every rounding
//
// Between its operands and t numbers are wide ones (rtl/float/wide_format.svh). LATENCY is spread over the steps in
// proportion to where they end at LATENCY 89:
//
//   from       origin - centre                                        4
//   along      (origin - centre) . direction: product 8, sums 12, 16
//   nearest    s = along / direction . direction                     32
//   offset     from - s * direction: product 36, sum 40
//   distance   offset . offset: product 44, sums 48, 52
//   delta      radius * radius - distance                            56
//   half       root of delta / direction . direction: 72, 84
//   ends       s - half, s + half                                    88
//   range      as binary32, tmin <= t <= tmax                        89
`include "wide_format.svh"

module sphere_intersect #(
    parameter int LATENCY = 89
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [95:0] origin_i,     // x in the lowest bits, also of direction and centre
    input  logic [95:0] direction_i,
    input  logic [31:0] tmin_i,
    input  logic [31:0] tmax_i,
    input  logic [95:0] centre_i,
    input  logic [31:0] radius_i,
    output logic        hit_o,
    output logic [31:0] t_o           // +0 without a hit
);
  // The last register of each step, counted from the entrance.
  localparam int FROM = 4 * LATENCY / 89;
  localparam int ALONG = 16 * LATENCY / 89;
  localparam int NEAREST = 32 * LATENCY / 89;
  localparam int STEPPED = 36 * LATENCY / 89;
  localparam int OFFSET = 40 * LATENCY / 89;
  localparam int DISTANCE = 52 * LATENCY / 89;
  localparam int DELTA = 56 * LATENCY / 89;
  localparam int RATIO = 72 * LATENCY / 89;
  localparam int HALF = 84 * LATENCY / 89;
  localparam int ENDS = 88 * LATENCY / 89;
  localparam int VECTOR = 3 * `WIDE_BITS;

  // The operands as wide numbers, and the origin as the centre sees it. What is wide without being normalised goes into an
  // adder.
  logic [VECTOR-1:0] direction, from;
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_operands
      logic [`WIDE_BITS-1:0] origin, centre;
      wide_from_float #(
          .NORMALISE(1'b0)
      ) convert_origin (
          .value_i (origin_i[32*axis+:32]),
          .result_o(origin)
      );
      wide_from_float #(
          .NORMALISE(1'b0)
      ) convert_centre (
          .value_i (centre_i[32*axis+:32]),
          .result_o(centre)
      );
      wide_from_float convert_direction (
          .value_i (direction_i[32*axis+:32]),
          .result_o(direction[`WIDE_BITS*axis+:`WIDE_BITS])
      );
      wide_add #(
          .LATENCY(FROM)
      ) subtract (
          .clk_i,
          .enable_i,
          .a_i(origin),
          .b_i(centre),
          .subtract_i(1'b1),
          .result_o(from[`WIDE_BITS*axis+:`WIDE_BITS])
      );
    end
  endgenerate
  logic [VECTOR-1:0] direction_from, direction_nearest;
  pipe_row #(
      .WIDTH(VECTOR),
      .DEPTH(FROM)
  ) row_direction_from (
      .clk_i,
      .enable_i,
      .data_i(direction),
      .data_o(direction_from)
  );
  pipe_row #(
      .WIDTH(VECTOR),
      .DEPTH(NEAREST - FROM)
  ) row_direction_nearest (
      .clk_i,
      .enable_i,
      .data_i(direction_from),
      .data_o(direction_nearest)
  );

  // t of the nearest point: s, with the other sign.
  logic [`WIDE_BITS-1:0] along, square, square_delta, nearest, nearest_ends;
  wide_dot #(
      .LATENCY(ALONG - FROM)
  ) project (
      .clk_i,
      .enable_i,
      .p_i(from),
      .q_i(direction_from),
      .result_o(along)
  );
  wide_dot #(
      .LATENCY(ALONG - FROM)
  ) square_direction (
      .clk_i,
      .enable_i,
      .p_i(direction_from),
      .q_i(direction_from),
      .result_o(square)
  );
  wide_quotient #(
      .LATENCY(NEAREST - ALONG)
  ) divide_along (
      .clk_i,
      .enable_i,
      .a_i(along),
      .b_i(square),
      .result_o(nearest)
  );

  // How far the nearest point is from the centre: from + s direction, as from - nearest direction.
  logic [VECTOR-1:0] offset;
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_offset
      logic [`WIDE_BITS-1:0] step, from_stepped;
      wide_mul #(
          .LATENCY(STEPPED - NEAREST)
      ) scale (
          .clk_i,
          .enable_i,
          .a_i(nearest),
          .b_i(direction_nearest[`WIDE_BITS*axis+:`WIDE_BITS]),
          .result_o(step)
      );
      pipe_row #(
          .WIDTH(`WIDE_BITS),
          .DEPTH(STEPPED - FROM)
      ) row_from (
          .clk_i,
          .enable_i,
          .data_i(from[`WIDE_BITS*axis+:`WIDE_BITS]),
          .data_o(from_stepped)
      );
      wide_add #(
          .LATENCY(OFFSET - STEPPED)
      ) go (
          .clk_i,
          .enable_i,
          .a_i(from_stepped),
          .b_i(step),
          .subtract_i(1'b1),
          .result_o(offset[`WIDE_BITS*axis+:`WIDE_BITS])
      );
    end
  endgenerate
  logic [`WIDE_BITS-1:0] distance;
  wide_dot #(
      .LATENCY(DISTANCE - OFFSET)
  ) square_offset (
      .clk_i,
      .enable_i,
      .p_i(offset),
      .q_i(offset),
      .result_o(distance)
  );

  // Half of the chord.
  logic [31:0] radius_offset;
  logic [`WIDE_BITS-1:0] radius, radius_square, delta, ratio, half;
  pipe_row #(
      .WIDTH(32),
      .DEPTH(OFFSET)
  ) row_radius (
      .clk_i,
      .enable_i,
      .data_i(radius_i),
      .data_o(radius_offset)
  );
  wide_from_float convert_radius (
      .value_i (radius_offset),
      .result_o(radius)
  );
  wide_mul #(
      .LATENCY(DISTANCE - OFFSET)
  ) square_radius (
      .clk_i,
      .enable_i,
      .a_i(radius),
      .b_i(radius),
      .result_o(radius_square)
  );
  wide_add #(
      .LATENCY(DELTA - DISTANCE)
  ) subtract_distance (
      .clk_i,
      .enable_i,
      .a_i(radius_square),
      .b_i(distance),
      .subtract_i(1'b1),
      .result_o(delta)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(DELTA - ALONG)
  ) row_square (
      .clk_i,
      .enable_i,
      .data_i(square),
      .data_o(square_delta)
  );
  wide_quotient #(
      .LATENCY(RATIO - DELTA)
  ) divide_delta (
      .clk_i,
      .enable_i,
      .a_i(delta),
      .b_i(square_delta),
      .result_o(ratio)
  );
  wide_sqrt #(
      .LATENCY(HALF - RATIO)
  ) take_root (
      .clk_i,
      .enable_i,
      .a_i(ratio),
      .result_o(half)
  );
  logic misses, misses_ends;
`ifdef CTU_MUTATE_SPHERE_GRAZED_MISSES
  assign misses = delta[`WIDE_SIGN] || !delta[`WIDE_NOT_ZERO];
`else
  assign misses = delta[`WIDE_SIGN] && delta[`WIDE_NOT_ZERO];
`endif
  pipe_row #(
      .WIDTH(1),
      .DEPTH(ENDS - DELTA)
  ) row_misses (
      .clk_i,
      .enable_i,
      .data_i(misses),
      .data_o(misses_ends)
  );

  // The chord's ends, the nearer one first: s - half and s + half, s being nearest with the other sign.
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(HALF - NEAREST)
  ) row_nearest (
      .clk_i,
      .enable_i,
      .data_i({nearest[`WIDE_NOT_ZERO] && !nearest[`WIDE_SIGN], nearest[`WIDE_SIGN-1:0]}),
      .data_o(nearest_ends)
  );
  logic [31:0] tmin, tmax;
  pipe_row #(
      .WIDTH(64),
      .DEPTH(ENDS)
  ) row_range (
      .clk_i,
      .enable_i,
      .data_i({tmin_i, tmax_i}),
      .data_o({tmin, tmax})
  );
  logic [63:0] ends;
  logic [1:0] before_tmin, beyond_tmax;
  logic [7:0] unused_compare;
  generate
    for (genvar far = 0; far < 2; far++) begin : g_end
      logic [`WIDE_BITS-1:0] wide_end;
      wide_add #(
          .LATENCY(ENDS - HALF)
      ) add_half (
          .clk_i,
          .enable_i,
          .a_i(nearest_ends),
          .b_i(half),
          .subtract_i(far == 0),
          .result_o(wide_end)
      );
      wide_to_float narrow (
          .value_i (wide_end),
          .result_o(ends[32*far+:32])
      );
      float_compare compare_tmin (
          .a_i(ends[32*far+:32]),
          .b_i(tmin),
          .less_o(before_tmin[far]),
          .equal_o(unused_compare[4*far]),
          .unordered_o(unused_compare[4*far+1])
      );
      float_compare compare_tmax (
          .a_i(tmax),
          .b_i(ends[32*far+:32]),
          .less_o(beyond_tmax[far]),
          .equal_o(unused_compare[4*far+2]),
          .unordered_o(unused_compare[4*far+3])
      );
    end
  endgenerate
  logic far_end, hit;
  always_comb begin
    far_end = before_tmin[0];
`ifdef CTU_MUTATE_SPHERE_NO_FAR_END
    far_end = 1'b0;
`endif
    hit = !misses_ends && !before_tmin[far_end] && !beyond_tmax[far_end];
  end
  pipe_row #(
      .WIDTH(33),
      .DEPTH(LATENCY - ENDS)
  ) row_result (
      .clk_i,
      .enable_i,
      .data_i({hit, !hit ? 32'd0 : far_end ? ends[63:32] : ends[31:0]}),
      .data_o({hit_o, t_o})
  );
endmodule
