// comparator_lane: the cells that the ray touches within [t0, t1] of one lane that the slab test hit; the datapath of one of
// cell_locate's units in the design without tables.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    ctu::cull::comparator_mask (model/cull/comparators.cpp)
//
// Arithmetic: on each axis, cell i holds the ray from the time of its first border, rounded down, to that of its second,
// rounded up (plane_times, faces included), within [t0, t1]; of a ray that stands still there, always or never. A cell of
// two axes is touched when the two intervals meet, a cell of three when they meet in pairs. mask_o has bit x + R (y + R z).
// Vectors of three hold axis x in the lowest 32 bits. No NaN comes of a lane that the slab test hit.
//
// Twelve steps: product (3), sum (4), key, clamp, touch, meet, AND; the LATENCY registers are spread over the places behind
// each of them, the last place first.
module comparator_lane #(
    parameter int R = 4,
    parameter int LATENCY = 12
) (
    input  logic               clk_i,
    input  logic               enable_i,
    input  logic [       95:0] lo_i,
    input  logic [       95:0] hi_i,
    input  logic [       95:0] origin_i,
    input  logic [        2:0] zero_axes_i,
    input  logic [        2:0] negative_axes_i,
    input  logic [       95:0] near_down_i,
    input  logic [       95:0] near_up_i,
    input  logic [       95:0] far_down_i,
    input  logic [       95:0] far_up_i,
    input  logic [       31:0] t0_i,
    input  logic [       31:0] t1_i,
    output logic [R*R*R-1:0] mask_o
);
  localparam int MULTIPLY_LATENCY = 3 * LATENCY / 12;
  localparam int ADD_LATENCY = 7 * LATENCY / 12 - 3 * LATENCY / 12;
  localparam int KEY_LATENCY = 8 * LATENCY / 12 - 7 * LATENCY / 12;
  localparam int CLAMP_LATENCY = 9 * LATENCY / 12 - 8 * LATENCY / 12;
  localparam int TOUCH_LATENCY = 10 * LATENCY / 12 - 9 * LATENCY / 12;
  localparam int MEET_LATENCY = 11 * LATENCY / 12 - 10 * LATENCY / 12;
  localparam int AND_LATENCY = LATENCY - 11 * LATENCY / 12;

  logic [63:0] t_keys, t_keys_q;  // t0 below, t1 above
  float_key key_of_t0 (
      .a_i(t0_i),
      .key_o(t_keys[31:0])
  );
  float_key key_of_t1 (
      .a_i(t1_i),
      .key_o(t_keys[63:32])
  );
  pipe_row #(
      .WIDTH(64),
      .DEPTH(MULTIPLY_LATENCY + ADD_LATENCY + KEY_LATENCY)
  ) row_times (
      .clk_i,
      .enable_i,
      .data_i(t_keys),
      .data_o(t_keys_q)
  );

  // Of each axis: when the ray is in each of its cells, in the order of ray time, and which it is in at all.
  logic [96*R-1:0] enter, leave;
  logic [3*R-1:0] touched;
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_axis
      comparator_axis #(
          .R(R),
          .MULTIPLY_LATENCY(MULTIPLY_LATENCY),
          .ADD_LATENCY(ADD_LATENCY),
          .KEY_LATENCY(KEY_LATENCY),
          .CLAMP_LATENCY(CLAMP_LATENCY),
          .TOUCH_LATENCY(TOUCH_LATENCY)
      ) cells (
          .clk_i,
          .enable_i,
          .lo_i(lo_i[32*axis+:32]),
          .hi_i(hi_i[32*axis+:32]),
          .origin_i(origin_i[32*axis+:32]),
          .zero_i(zero_axes_i[axis]),
          .near_down_i(near_down_i[32*axis+:32]),
          .near_up_i(near_up_i[32*axis+:32]),
          .far_down_i(far_down_i[32*axis+:32]),
          .far_up_i(far_up_i[32*axis+:32]),
          .t0_i(t_keys_q[31:0]),
          .t1_i(t_keys_q[63:32]),
          .enter_o(enter[32*R*axis+:32*R]),
          .leave_o(leave[32*R*axis+:32*R]),
          .touched_o(touched[R*axis+:R])
      );
    end
  endgenerate

  // Which cells of two axes share a time: x and y, y and z, x and z; bit i + R j for cell i of the first and j of the second.
  logic [3*R*R-1:0] meet, meet_q;
  logic [2:0] descending_q;
  pipe_row #(
      .WIDTH(3),
      .DEPTH(LATENCY - AND_LATENCY)
  ) row_directions (
      .clk_i,
      .enable_i,
      .data_i(negative_axes_i),
      .data_o(descending_q)
  );
  generate
    for (genvar pair = 0; pair < 3; pair++) begin : g_pair
      localparam int A = pair == 1 ? 1 : 0;
      localparam int B = pair == 0 ? 1 : 2;
      for (genvar cell_b = 0; cell_b < R; cell_b++) begin : g_b
        for (genvar cell_a = 0; cell_a < R; cell_a++) begin : g_a
`ifdef CTU_MUTATE_CELLS_NEVER_TOUCHED
          wire both_touched = 1'b1;
          wire unused_touched = &{1'b0, touched[R*A+cell_a], touched[R*B+cell_b]};
`else
          wire both_touched = touched[R*A+cell_a] && touched[R*B+cell_b];
`endif
          assign meet[R*R*pair+R*cell_b+cell_a] = both_touched &&
              enter[32*(R*A+cell_a)+:32] <= leave[32*(R*B+cell_b)+:32] &&
              enter[32*(R*B+cell_b)+:32] <= leave[32*(R*A+cell_a)+:32];
        end
      end
    end
  endgenerate
  pipe_row #(
      .WIDTH(3 * R * R),
      .DEPTH(MEET_LATENCY)
  ) row_meet (
      .clk_i,
      .enable_i,
      .data_i(meet),
      .data_o(meet_q)
  );

  // From the order of ray time to that of the cells, and the AND of the three.
  logic [3*R*R-1:0] ordered;
  logic [R*R*R-1:0] mask;
  generate
    for (genvar pair = 0; pair < 3; pair++) begin : g_order
      localparam int A = pair == 1 ? 1 : 0;
      localparam int B = pair == 0 ? 1 : 2;
      logic [R*R-1:0] rows;
      for (genvar j = 0; j < R; j++) begin : g_j
        for (genvar i = 0; i < R; i++) begin : g_i
          assign rows[R*j+i] = descending_q[A] ? meet_q[R*R*pair+R*j+R-1-i] : meet_q[R*R*pair+R*j+i];
          assign ordered[R*R*pair+R*j+i] = descending_q[B] ? rows[R*(R-1-j)+i] : rows[R*j+i];
        end
      end
    end
    for (genvar z = 0; z < R; z++) begin : g_z
      for (genvar y = 0; y < R; y++) begin : g_y
        for (genvar x = 0; x < R; x++) begin : g_x
          assign mask[x+R*(y+R*z)] = ordered[R*y+x] && ordered[R*R+R*z+y] && ordered[2*R*R+R*z+x];
        end
      end
    end
  endgenerate
  pipe_row #(
      .WIDTH(R * R * R),
      .DEPTH(AND_LATENCY)
  ) row_mask (
      .clk_i,
      .enable_i,
      .data_i(mask),
      .data_o(mask_o)
  );
endmodule
