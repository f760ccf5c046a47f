// cell_locate_axis: the cells on one axis of a box's grid in which the overlap of ray and box may begin and end.
//
//   latency PLANE_LATENCY + COMPARE_LATENCY + COUNT_LATENCY, where PLANE_LATENCY is MULTIPLY_LATENCY + ADD_LATENCY; initiation
//           interval 1; enable_i stops all registers
//   twin    Planes and locate_axis (model/cull/cell_locate.cpp)
//
// Arithmetic: plane_times between the faces' times, of a ray that stands still on this axis between the faces
// themselves. The cells of a time are as many as inner planes at or below it: going up, a plane is below from the
// moment it is met on; going down, until after it is met. A plane that the time's bounds leave undecided makes for one
// candidate more. A flat box has cell 0. No NaN comes of a lane that the slab test hit.
//
// The times in question come as keys (float_key) PLANE_LATENCY later than the rest, with the planes that they are compared with.
module cell_locate_axis #(
    parameter int R_RAY = 4,
    parameter int MULTIPLY_LATENCY = 3,
    parameter int ADD_LATENCY = 4,
    parameter int COMPARE_LATENCY = 1,
    parameter int COUNT_LATENCY = 1
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] lo_i,
    input  logic [31:0] hi_i,
    input  logic [31:0] origin_i,
    input  logic        zero_i,        // the direction is zero here
    input  logic        negative_i,    // the direction is negative here
    input  logic [31:0] near_down_i,   // of the plane that the ray meets first
    input  logic [31:0] near_up_i,
    input  logic [31:0] far_down_i,
    input  logic [31:0] far_up_i,
    input  logic [31:0] entry_down_i,  // PLANE_LATENCY later
    input  logic [31:0] entry_up_i,
    input  logic [31:0] exit_down_i,
    input  logic [31:0] exit_up_i,
    output logic [ 4:0] begin_first_o,
    output logic [ 4:0] begin_last_o,
    output logic [ 4:0] end_first_o,
    output logic [ 4:0] end_last_o
);
  localparam int PLANES = R_RAY - 1;

  logic [32*PLANES-1:0] down, up;
  plane_times #(
      .R(R_RAY),
      .MULTIPLY_LATENCY(MULTIPLY_LATENCY),
      .ADD_LATENCY(ADD_LATENCY)
  ) planes (
      .clk_i,
      .enable_i,
      .first_down_i(zero_i ? lo_i : near_down_i),
      .first_up_i(zero_i ? lo_i : near_up_i),
      .second_down_i(zero_i ? hi_i : far_down_i),
      .second_up_i(zero_i ? hi_i : far_up_i),
      .down_o(down),
      .up_o(up)
  );

  logic [31:0] lo_key, hi_key, origin_key, origin_key_q;
  logic still_q, descending_q, flat_q;
  float_key key_of_lo (
      .a_i(lo_i),
      .key_o(lo_key)
  );
  float_key key_of_hi (
      .a_i(hi_i),
      .key_o(hi_key)
  );
  float_key key_of_origin (
      .a_i(origin_i),
      .key_o(origin_key)
  );
  pipe_row #(
      .WIDTH(35),
      .DEPTH(MULTIPLY_LATENCY + ADD_LATENCY)
  ) row_axis (
      .clk_i,
      .enable_i,
      .data_i({origin_key, zero_i, negative_i && !zero_i, lo_key == hi_key}),
      .data_o({origin_key_q, still_q, descending_q, flat_q})
  );

  // Each plane against both times; of a ray that stands still, twice against its place.
  logic [32*PLANES-1:0] down_key, up_key;
  generate
    for (genvar plane = 0; plane < PLANES; plane++) begin : g_key
      float_key key_of_down (
          .a_i(down[32*plane+:32]),
          .key_o(down_key[32*plane+:32])
      );
      float_key key_of_up (
          .a_i(up[32*plane+:32]),
          .key_o(up_key[32*plane+:32])
      );
    end
  endgenerate

  logic [PLANES-1:0] begin_below, begin_undecided, end_below, end_undecided;
  logic [PLANES-1:0] begin_below_q, begin_undecided_q, end_below_q, end_undecided_q;
  generate
    for (genvar place = 0; place < 2; place++) begin : g_place
      logic [31:0] time_down, time_up;
      logic [PLANES-1:0] passed, ahead, below, undecided;
      assign time_down = still_q ? origin_key_q : place == 0 ? entry_down_i : exit_down_i;
      assign time_up = still_q ? origin_key_q : place == 0 ? entry_up_i : exit_up_i;
      always_comb begin
        for (int plane = 0; plane < PLANES; plane++) begin
`ifdef CTU_MUTATE_PLANES_MET_ARE_PASSED
          passed[plane] = up_key[32*plane+:32] <= time_down;
          ahead[plane] = down_key[32*plane+:32] > time_up;
`else
          passed[plane] = descending_q ? up_key[32*plane+:32] < time_down : up_key[32*plane+:32] <= time_down;
          ahead[plane] = descending_q ? down_key[32*plane+:32] >= time_up : down_key[32*plane+:32] > time_up;
`endif
        end
        below = descending_q ? ahead : passed;
        undecided = ~(passed | ahead);
`ifndef CTU_MUTATE_FLAT_BOX
        if (flat_q) begin
          below = '0;
          undecided = '0;
        end
`endif
      end
      if (place == 0) begin : g_begin
        assign begin_below = below;
        assign begin_undecided = undecided;
      end else begin : g_end
        assign end_below = below;
        assign end_undecided = undecided;
      end
    end
  endgenerate
`ifdef CTU_MUTATE_FLAT_BOX
  wire unused_flat = flat_q;
`endif
  pipe_row #(
      .WIDTH(4 * PLANES),
      .DEPTH(COMPARE_LATENCY)
  ) row_compared (
      .clk_i,
      .enable_i,
      .data_i({begin_below, begin_undecided, end_below, end_undecided}),
      .data_o({begin_below_q, begin_undecided_q, end_below_q, end_undecided_q})
  );

  logic [4:0] begin_first, begin_more, end_first, end_more;
  always_comb begin
    begin_first = 5'd0;
    begin_more = 5'd0;
    end_first = 5'd0;
    end_more = 5'd0;
    for (int plane = 0; plane < PLANES; plane++) begin
      begin_first += {4'd0, begin_below_q[plane]};
      begin_more += {4'd0, begin_undecided_q[plane]};
      end_first += {4'd0, end_below_q[plane]};
      end_more += {4'd0, end_undecided_q[plane]};
    end
  end
  pipe_row #(
      .WIDTH(20),
      .DEPTH(COUNT_LATENCY)
  ) row_counted (
      .clk_i,
      .enable_i,
      .data_i({begin_first, begin_first + begin_more, end_first, end_first + end_more}),
      .data_o({begin_first_o, begin_last_o, end_first_o, end_last_o})
  );
endmodule
