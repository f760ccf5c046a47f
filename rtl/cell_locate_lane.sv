// cell_locate_lane: the key of one lane that the slab test hit: the cells in which the overlap of ray and box begins and
// ends, or a column that holds both; the datapath of one of cell_locate's units in designs with tables.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    ctu::cull::cell_locate (model/cull/cell_locate.cpp)
//
// Arithmetic: the overlap begins between t0 and the latest near_up, t0 included, and ends between the earliest far_down, t1
// included, and t1 (cell_locate_axis). key_o is CellKey::packed without its unused bit 30: begin x, y, z in bits 0..14, end
// in 15..29, uncertain in 30. Vectors of three hold axis x in the lowest 32 bits.
//
// Ten steps: product (3), sum (4), compare, count, pack; the LATENCY registers are spread over the places behind each of
// them, the last place first.
module cell_locate_lane #(
    parameter int R_RAY = 4,
    parameter int LATENCY = 10
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [95:0] lo_i,
    input  logic [95:0] hi_i,
    input  logic [95:0] origin_i,
    input  logic [ 2:0] zero_axes_i,
    input  logic [ 2:0] negative_axes_i,
    input  logic [95:0] near_down_i,
    input  logic [95:0] near_up_i,
    input  logic [95:0] far_down_i,
    input  logic [95:0] far_up_i,
    input  logic [31:0] t0_i,
    input  logic [31:0] t1_i,
    output logic [30:0] key_o
);
  localparam int MULTIPLY_LATENCY = 3 * LATENCY / 10;
  localparam int ADD_LATENCY = 7 * LATENCY / 10 - 3 * LATENCY / 10;
  localparam int COMPARE_LATENCY = 8 * LATENCY / 10 - 7 * LATENCY / 10;
  localparam int COUNT_LATENCY = 9 * LATENCY / 10 - 8 * LATENCY / 10;
  localparam int PACK_LATENCY = LATENCY - 9 * LATENCY / 10;

  // The range of either time, beside products and sums: first among two pairs, then of the two.
  logic [31:0] t0_key, t1_key;
  logic [95:0] near_up_key, far_down_key;
  float_key key_of_t0 (
      .a_i(t0_i),
      .key_o(t0_key)
  );
  float_key key_of_t1 (
      .a_i(t1_i),
      .key_o(t1_key)
  );
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_key
      float_key key_of_near_up (
          .a_i(near_up_i[32*axis+:32]),
          .key_o(near_up_key[32*axis+:32])
      );
      float_key key_of_far_down (
          .a_i(far_down_i[32*axis+:32]),
          .key_o(far_down_key[32*axis+:32])
      );
    end
  endgenerate

  logic [31:0] latest_a, latest_b, earliest_a, earliest_b, latest_a_q, latest_b_q, earliest_a_q, earliest_b_q;
  logic [31:0] t0_key_q, t1_key_q;
  always_comb begin
    latest_a = t0_key > near_up_key[31:0] ? t0_key : near_up_key[31:0];
    latest_b = near_up_key[63:32] > near_up_key[95:64] ? near_up_key[63:32] : near_up_key[95:64];
    earliest_a = t1_key < far_down_key[31:0] ? t1_key : far_down_key[31:0];
    earliest_b = far_down_key[63:32] < far_down_key[95:64] ? far_down_key[63:32] : far_down_key[95:64];
  end
  pipe_row #(
      .WIDTH(192),
      .DEPTH(MULTIPLY_LATENCY)
  ) row_pairs (
      .clk_i,
      .enable_i,
      .data_i({t0_key, t1_key, latest_a, latest_b, earliest_a, earliest_b}),
      .data_o({t0_key_q, t1_key_q, latest_a_q, latest_b_q, earliest_a_q, earliest_b_q})
  );
  logic [31:0] entry_down, entry_up, exit_down, exit_up;
  pipe_row #(
      .WIDTH(128),
      .DEPTH(ADD_LATENCY)
  ) row_range (
      .clk_i,
      .enable_i,
      .data_i({t0_key_q, latest_a_q > latest_b_q ? latest_a_q : latest_b_q,
               earliest_a_q < earliest_b_q ? earliest_a_q : earliest_b_q, t1_key_q}),
      .data_o({entry_down, entry_up, exit_down, exit_up})
  );

  logic [14:0] begin_first, begin_last, end_first, end_last;
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_axis
      cell_locate_axis #(
          .R_RAY(R_RAY),
          .MULTIPLY_LATENCY(MULTIPLY_LATENCY),
          .ADD_LATENCY(ADD_LATENCY),
          .COMPARE_LATENCY(COMPARE_LATENCY),
          .COUNT_LATENCY(COUNT_LATENCY)
      ) cells (
          .clk_i,
          .enable_i,
          .lo_i(lo_i[32*axis+:32]),
          .hi_i(hi_i[32*axis+:32]),
          .origin_i(origin_i[32*axis+:32]),
          .zero_i(zero_axes_i[axis]),
          .negative_i(negative_axes_i[axis]),
          .near_down_i(near_down_i[32*axis+:32]),
          .near_up_i(near_up_i[32*axis+:32]),
          .far_down_i(far_down_i[32*axis+:32]),
          .far_up_i(far_up_i[32*axis+:32]),
          .entry_down_i(entry_down),
          .entry_up_i(entry_up),
          .exit_down_i(exit_down),
          .exit_up_i(exit_up),
          .begin_first_o(begin_first[5*axis+:5]),
          .begin_last_o(begin_last[5*axis+:5]),
          .end_first_o(end_first[5*axis+:5]),
          .end_last_o(end_last[5*axis+:5])
      );
    end
  endgenerate

  // A doubt on one axis only, with one certain cell on each other one, becomes a column; any other one leaves the key
  // uncertain, with the first candidates in it.
  logic [2:0] undecided, several;
  logic one_undecided, one_several;
  logic [30:0] key;
  always_comb begin
    key = 31'd0;
    for (int axis = 0; axis < 3; axis++) begin
      undecided[axis] =
          begin_first[5*axis+:5] != begin_last[5*axis+:5] || end_first[5*axis+:5] != end_last[5*axis+:5];
      several[axis] = undecided[axis] || begin_first[5*axis+:5] != end_first[5*axis+:5];
    end
    one_undecided = undecided == 3'd1 || undecided == 3'd2 || undecided == 3'd4;
    one_several = several == 3'd1 || several == 3'd2 || several == 3'd4;
    for (int axis = 0; axis < 3; axis++) begin
      key[5*axis+:5] = begin_first[5*axis+:5];
      key[15+5*axis+:5] = end_first[5*axis+:5];
`ifndef CTU_MUTATE_NO_COLUMN
      if (one_undecided && one_several && undecided[axis]) begin
        if (end_first[5*axis+:5] < begin_first[5*axis+:5]) key[5*axis+:5] = end_first[5*axis+:5];
        key[15+5*axis+:5] =
            begin_last[5*axis+:5] > end_last[5*axis+:5] ? begin_last[5*axis+:5] : end_last[5*axis+:5];
      end
`endif
    end
    // Not all doubts are on one axis, or another axis has several cells.
    key[30] = undecided != 3'd0 && !one_several;
  end
  pipe_row #(
      .WIDTH(31),
      .DEPTH(PACK_LATENCY)
  ) row_packed (
      .clk_i,
      .enable_i,
      .data_i(key),
      .data_o(key_o)
  );
endmodule
