// comparator_axis: when the ray is in each of the R cells of one axis of a box's grid, within [t0, t1].
//
//   latency MULTIPLY_LATENCY + ADD_LATENCY + KEY_LATENCY + CLAMP_LATENCY + TOUCH_LATENCY, initiation interval 1; enable_i stops
//           all registers
//   twin    cell_times (model/cull/comparators.cpp)
//
// Arithmetic: cell i of ray time lies between borders i and i + 1 of the R + 1: face, inner planes (plane_times), face. The
// first is rounded down, the second up. Times are keys (float_key) from step KEY on; t0 and t1 come as keys at its end. A
// ray that stands still on this axis is in the closed cells that hold its place, from t0 to t1. Cells that are not
// touched have any times.
module comparator_axis #(
    parameter int R = 4,
    parameter int MULTIPLY_LATENCY = 3,
    parameter int ADD_LATENCY = 4,
    parameter int KEY_LATENCY = 1,
    parameter int CLAMP_LATENCY = 1,
    parameter int TOUCH_LATENCY = 1
) (
    input  logic            clk_i,
    input  logic            enable_i,
    input  logic [    31:0] lo_i,
    input  logic [    31:0] hi_i,
    input  logic [    31:0] origin_i,
    input  logic            zero_i,       // the direction is zero here
    input  logic [    31:0] near_down_i,  // of the plane that the ray meets first
    input  logic [    31:0] near_up_i,
    input  logic [    31:0] far_down_i,
    input  logic [    31:0] far_up_i,
    input  logic [    31:0] t0_i,         // MULTIPLY_LATENCY + ADD_LATENCY + KEY_LATENCY later
    input  logic [    31:0] t1_i,
    output logic [32*R-1:0] enter_o,
    output logic [32*R-1:0] leave_o,
    output logic [   R-1:0] touched_o
);
  logic [31:0] first_down, first_up, second_down, second_up;
  always_comb begin
    first_down = zero_i ? lo_i : near_down_i;
    first_up = zero_i ? lo_i : near_up_i;
    second_down = zero_i ? hi_i : far_down_i;
    second_up = zero_i ? hi_i : far_up_i;
  end
  logic [32*(R-1)-1:0] down, up;
  plane_times #(
      .R(R),
      .MULTIPLY_LATENCY(MULTIPLY_LATENCY),
      .ADD_LATENCY(ADD_LATENCY)
  ) planes (
      .clk_i,
      .enable_i,
      .first_down_i(first_down),
      .first_up_i(first_up),
      .second_down_i(second_down),
      .second_up_i(second_up),
      .down_o(down),
      .up_o(up)
  );
  logic [31:0] first_down_q, second_up_q, origin_q;
  logic still_q;
  pipe_row #(
      .WIDTH(97),
      .DEPTH(MULTIPLY_LATENCY + ADD_LATENCY)
  ) row_faces (
      .clk_i,
      .enable_i,
      .data_i({first_down, second_up, origin_i, zero_i}),
      .data_o({first_down_q, second_up_q, origin_q, still_q})
  );

  // Keys: border i rounded down begins cell i, border i + 1 rounded up ends it.
  logic [32*R-1:0] enter, leave, enter_key, leave_key, enter_key_q, leave_key_q;
  logic [31:0] origin_key, origin_key_q;
  logic still_key_q;
  assign enter = {down, first_down_q};
  assign leave = {second_up_q, up};
  float_key key_of_origin (
      .a_i(origin_q),
      .key_o(origin_key)
  );
  generate
    for (genvar i = 0; i < R; i++) begin : g_key
      float_key key_of_enter (
          .a_i(enter[32*i+:32]),
          .key_o(enter_key[32*i+:32])
      );
      float_key key_of_leave (
          .a_i(leave[32*i+:32]),
          .key_o(leave_key[32*i+:32])
      );
    end
  endgenerate
  pipe_row #(
      .WIDTH(64 * R + 33),
      .DEPTH(KEY_LATENCY)
  ) row_keys (
      .clk_i,
      .enable_i,
      .data_i({enter_key, leave_key, origin_key, still_q}),
      .data_o({enter_key_q, leave_key_q, origin_key_q, still_key_q})
  );

  // Clamped to [t0, t1]; of a ray that stands still, the borders against its place.
  logic [32*R-1:0] clamped_enter, clamped_leave, clamped_enter_q, clamped_leave_q;
  logic [R-1:0] holds, holds_q;
  logic still_clamp_q;
  always_comb begin
    for (int i = 0; i < R; i++) begin
      clamped_enter[32*i+:32] = still_key_q || t0_i > enter_key_q[32*i+:32] ? t0_i : enter_key_q[32*i+:32];
      clamped_leave[32*i+:32] = still_key_q || t1_i < leave_key_q[32*i+:32] ? t1_i : leave_key_q[32*i+:32];
      holds[i] = enter_key_q[32*i+:32] <= origin_key_q && origin_key_q <= leave_key_q[32*i+:32];
    end
  end
  pipe_row #(
      .WIDTH(65 * R + 1),
      .DEPTH(CLAMP_LATENCY)
  ) row_clamped (
      .clk_i,
      .enable_i,
      .data_i({clamped_enter, clamped_leave, holds, still_key_q}),
      .data_o({clamped_enter_q, clamped_leave_q, holds_q, still_clamp_q})
  );

  logic [R-1:0] touched;
  always_comb begin
    for (int i = 0; i < R; i++) begin
      touched[i] = still_clamp_q ? holds_q[i] : clamped_enter_q[32*i+:32] <= clamped_leave_q[32*i+:32];
    end
  end
  pipe_row #(
      .WIDTH(65 * R),
      .DEPTH(TOUCH_LATENCY)
  ) row_touched (
      .clk_i,
      .enable_i,
      .data_i({clamped_enter_q, clamped_leave_q, touched}),
      .data_o({enter_o, leave_o, touched_o})
  );
endmodule
