// box_test_lane: the ray against one box, with outward rounding; the datapath of one of box_test's lanes.
//
//   latency SUBTRACT_LATENCY + MULTIPLY_LATENCY + COMPARE_LATENCY (docs/unit.md: 4 + 4 + 3), initiation interval 1;
//           enable_i stops all registers
//   twin    one lane of ctu::intersect::slab_test, without INNER of slab_test_outer (model/intersect/slab_test.h)
//
// Arithmetic: slab_axis on each axis; t0 = max(tmin, near_down...), t1 = min(tmax, far_up...), hit where t0 <= t1. No NaN
// occurs for a valid ray. Vectors of three hold axis x in the lowest 32 bits.
module box_test_lane #(
    parameter int SUBTRACT_LATENCY = 4,
    parameter int MULTIPLY_LATENCY = 4,
    parameter int COMPARE_LATENCY = 3,
    parameter bit INNER = 1'b1  // 0: the bounds by axis are zero
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [95:0] lo_i,
    input  logic [95:0] hi_i,
    input  logic [95:0] origin_i,
    input  logic [95:0] rcp_down_i,
    input  logic [95:0] rcp_up_i,
    input  logic [ 2:0] zero_axes_i,
    input  logic [ 2:0] negative_axes_i,
    input  logic [31:0] tmin_i,
    input  logic [31:0] tmax_i,           // the best hit so far
    output logic [95:0] near_down_o,
    output logic [95:0] near_up_o,
    output logic [95:0] far_down_o,
    output logic [95:0] far_up_o,
    output logic [31:0] t0_o,
    output logic [31:0] t1_o,
    output logic        hit_o
);
  // Registers behind the three steps of the comparison.
  localparam int REGISTERS_1 = COMPARE_LATENCY / 3;
  localparam int REGISTERS_2 = 2 * COMPARE_LATENCY / 3 - COMPARE_LATENCY / 3;
  localparam int REGISTERS_3 = COMPARE_LATENCY - 2 * COMPARE_LATENCY / 3;

  logic [95:0] near_down, near_up, far_down, far_up;
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_axis
      slab_axis #(
          .SUBTRACT_LATENCY(SUBTRACT_LATENCY),
          .MULTIPLY_LATENCY(MULTIPLY_LATENCY),
          .INNER(INNER)
      ) slab (
          .clk_i,
          .enable_i,
          .lo_i(lo_i[32*axis+:32]),
          .hi_i(hi_i[32*axis+:32]),
          .origin_i(origin_i[32*axis+:32]),
          .rcp_down_i(rcp_down_i[32*axis+:32]),
          .rcp_up_i(rcp_up_i[32*axis+:32]),
          .zero_i(zero_axes_i[axis]),
          .negative_i(negative_axes_i[axis]),
          .near_down_o(near_down[32*axis+:32]),
          .near_up_o(near_up[32*axis+:32]),
          .far_down_o(far_down[32*axis+:32]),
          .far_up_o(far_up[32*axis+:32])
      );
    end
  endgenerate
  generate
    if (INNER) begin : g_times
      pipe_row #(
          .WIDTH(384),
          .DEPTH(COMPARE_LATENCY)
      ) row_times (
          .clk_i,
          .enable_i,
          .data_i({near_down, near_up, far_down, far_up}),
          .data_o({near_down_o, near_up_o, far_down_o, far_up_o})
      );
    end else begin : g_no_times
      wire unused_inner = &{1'b0, near_up, far_down};
      assign {near_down_o, near_up_o, far_down_o, far_up_o} = '0;
    end
  endgenerate

  logic [31:0] tmin_q, tmax_q;
  pipe_row #(
      .WIDTH(64),
      .DEPTH(SUBTRACT_LATENCY + MULTIPLY_LATENCY)
  ) row_interval (
      .clk_i,
      .enable_i,
      .data_i({tmin_i, tmax_i}),
      .data_o({tmin_q, tmax_q})
  );

  // 1, 2: the latest entry and the earliest exit, by pairs.
  logic [31:0] entry_a, entry_b, exit_a, exit_b;
  float_min_max max_a (
      .a_i(tmin_q),
      .b_i(near_down[31:0]),
      .max_i(1'b1),
      .result_o(entry_a)
  );
  float_min_max max_b (
      .a_i(near_down[63:32]),
      .b_i(near_down[95:64]),
      .max_i(1'b1),
      .result_o(entry_b)
  );
  float_min_max min_a (
      .a_i(tmax_q),
      .b_i(far_up[31:0]),
      .max_i(1'b0),
      .result_o(exit_a)
  );
  float_min_max min_b (
      .a_i(far_up[63:32]),
      .b_i(far_up[95:64]),
      .max_i(1'b0),
      .result_o(exit_b)
  );
  logic [31:0] entry_a_q1, entry_b_q1, exit_a_q1, exit_b_q1;
  pipe_row #(
      .WIDTH(128),
      .DEPTH(REGISTERS_1)
  ) row_1 (
      .clk_i,
      .enable_i,
      .data_i({entry_a, entry_b, exit_a, exit_b}),
      .data_o({entry_a_q1, entry_b_q1, exit_a_q1, exit_b_q1})
  );

  logic [31:0] t0, t1, t0_q2, t1_q2;
  float_min_max max_t0 (
      .a_i(entry_a_q1),
      .b_i(entry_b_q1),
      .max_i(1'b1),
      .result_o(t0)
  );
  float_min_max min_t1 (
      .a_i(exit_a_q1),
      .b_i(exit_b_q1),
      .max_i(1'b0),
      .result_o(t1)
  );
  pipe_row #(
      .WIDTH(64),
      .DEPTH(REGISTERS_2)
  ) row_2 (
      .clk_i,
      .enable_i,
      .data_i({t0, t1}),
      .data_o({t0_q2, t1_q2})
  );

  // 3: entered before left.
  logic less, equal, unused_unordered;
  float_compare compare (
      .a_i(t0_q2),
      .b_i(t1_q2),
      .less_o(less),
      .equal_o(equal),
      .unordered_o(unused_unordered)
  );
  pipe_row #(
      .WIDTH(65),
      .DEPTH(REGISTERS_3)
  ) row_3 (
      .clk_i,
      .enable_i,
      .data_i({t0_q2, t1_q2, less || equal}),
      .data_o({t0_o, t1_o, hit_o})
  );
endmodule
