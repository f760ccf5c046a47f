// primitive_cull: the box of the ray's stay in a leaf against the box of each primitive there; those it misses are not
// tested.
//
//   in   leaf    a context and the leaf whose bytes have come
//   out  passed  the leaf, with the primitives that are left to test
//   out  missed  contexts whose leaf has none left
//   latency LATENCY, from 1; a leaf keeps the entrance for ceil(primitives / UNITS) cycles
//   twin    model/pipeline/primitive_cull.h; arithmetic: boxes_met in model/cull/leaf_culling.h
//   stated  docs/unit.md
//
// Reads of the context: the best t in the cycle in which a leaf takes the entrance; ray, stay and boxes in each cycle in
// which it keeps it, UNITS boxes a cycle. The ray's box is made again for each of these cycles, so what meets what needs
// no place to wait. LATENCY is spread over the steps in proportion to where they end at LATENCY 10: the end of the stay 1,
// products 5, sums 9, comparisons 10.
`include "tokens.svh"

module primitive_cull #(
    parameter int SLOT_BITS = 5,
    parameter int UNITS = 1,      // boxes compared in a cycle, 1 .. 4
    parameter int LATENCY = 10
) (
    input  logic                   clk_i,
    input  logic                   rst_i,
    input  logic                   leaf_valid_i,
    input  logic [ SLOT_BITS+31:0] leaf_data_i,
    output logic                   leaf_pop_o,
    input  logic                   passed_ready_i,
    output logic                   passed_push_o,
    output logic [ SLOT_BITS+47:0] passed_data_o,  // {slot, met, reference}
    input  logic                   missed_ready_i,
    output logic                   missed_push_o,
    output logic [  SLOT_BITS-1:0] missed_data_o,

    // The context that keeps the entrance.
    output logic [SLOT_BITS-1:0] slot_o,
    input  logic [         95:0] ray_origin_i,     // x in the lowest bits
    input  logic [         95:0] ray_direction_i,
    input  logic [         31:0] stay_begin_i,     // t of the ray's stay in the leaf's box
    input  logic [         31:0] stay_end_i,
    input  logic [         31:0] best_t_i,
    output logic [  4*UNITS-1:0] index_o,          // of the primitives whose boxes are compared
    input  logic [192*UNITS-1:0] box_i,            // lower.x lowest, then lower.y, lower.z, upper

    output logic [3:0] activity_o
);
  // The last register of each step, counted from the entrance.
  localparam int END = LATENCY / 10;
  localparam int PRODUCTS = 5 * LATENCY / 10;
  localparam int SUMS = 9 * LATENCY / 10;

  // The leaf at the entrance: the one that takes it in this cycle, or has taken it before.
  logic can_enter, start, enable, exit_valid, empty;
  logic [SLOT_BITS-1:0] slot_q;
  logic [31:0] reference_q, best_t_q;
  logic [3:0] index_q;
  wire enter = leaf_valid_i && can_enter;
  wire [31:0] reference = can_enter ? leaf_data_i[31:0] : reference_q;
  wire [3:0] first = can_enter ? 4'd0 : index_q;
  wire [31:0] best_t = can_enter ? best_t_i : best_t_q;
  assign slot_o = can_enter ? leaf_data_i[SLOT_BITS+31:32] : slot_q;
  assign leaf_pop_o = enter;
  always_ff @(posedge clk_i) begin
    if (enter) begin
      slot_q <= leaf_data_i[SLOT_BITS+31:32];
      reference_q <= leaf_data_i[31:0];
      best_t_q <= best_t_i;
    end
    if (enable) index_q <= first + 4'(UNITS);
  end

  wire [4:0] count = {1'b0, leaf_data_i[30:27]} + 5'd1;
  wire [4:0] occupies = (count + 5'(UNITS - 1)) / 5'(UNITS);
  logic leaves, unused_exit;
  pipe_control #(
      .LATENCY(LATENCY),
      .OCCUPIES_BITS(5)
  ) control (
      .clk_i,
      .rst_i,
      .enter_i(enter),
      .occupies_i(occupies),
      .ready_i(leaves),
      .can_enter_o(can_enter),
      .start_o(start),
      .enable_o(enable),
      .exit_valid_o(exit_valid),
      .exit_o(unused_exit),
      .empty_o(empty)
  );
  wire unused_start = start;

  // Where the stay ends, then its box.
  logic [31:0] stay_end, stay_end_q, stay_begin_q;
  logic [95:0] origin_q, direction_q;
  float_min_max cut (
      .a_i(stay_end_i),
      .b_i(best_t),
      .max_i(1'b0),
      .result_o(stay_end)
  );
  pipe_row #(
      .WIDTH(256),
      .DEPTH(END)
  ) row_stay (
      .clk_i,
      .enable_i(enable),
      .data_i({stay_end, stay_begin_i, ray_direction_i, ray_origin_i}),
      .data_o({stay_end_q, stay_begin_q, direction_q, origin_q})
  );
  logic [95:0] lower, upper;
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_axis
      ray_box_axis #(
          .MULTIPLY_LATENCY(PRODUCTS - END),
          .ADD_LATENCY(SUMS - PRODUCTS)
      ) axis_box (
          .clk_i,
          .enable_i(enable),
          .origin_i(origin_q[32*axis+:32]),
          .direction_i(direction_q[32*axis+:32]),
          .begin_i(stay_begin_q),
          .end_i(stay_end_q),
          .lower_o(lower[32*axis+:32]),
          .upper_o(upper[32*axis+:32])
      );
    end
  endgenerate

  // Boxes, each against that of the stay. A leaf of one primitive is tested without a box.
  wire alone = reference[30:27] == 4'd0;
  logic [UNITS-1:0] met, met_q;
  logic [3:0] first_sums, first_q;
  logic begins_q;
  logic [SLOT_BITS-1:0] slot_exit;
  logic [31:0] reference_exit;
  generate
    for (genvar u = 0; u < UNITS; u++) begin : g_unit
      assign index_o[4*u+:4] = first + 4'(u);
      logic [191:0] box;
      logic there, there_alone;  // the leaf has this primitive
      pipe_row #(
          .WIDTH(194),
          .DEPTH(SUMS)
      ) row_box (
          .clk_i,
          .enable_i(enable),
          .data_i({{1'b0, first} + 5'(u) <= {1'b0, reference[30:27]}, alone, box_i[192*u+:192]}),
          .data_o({there, there_alone, box})
      );
      logic [2:0] below, above;
      for (genvar axis = 0; axis < 3; axis++) begin : g_axis
        logic [3:0] unused_compare;
        float_compare compare_lower (
            .a_i(box[96+32*axis+:32]),
            .b_i(lower[32*axis+:32]),
            .less_o(below[axis]),
            .equal_o(unused_compare[0]),
            .unordered_o(unused_compare[1])
        );
        float_compare compare_upper (
            .a_i(upper[32*axis+:32]),
            .b_i(box[32*axis+:32]),
            .less_o(above[axis]),
            .equal_o(unused_compare[2]),
            .unordered_o(unused_compare[3])
        );
      end
`ifdef CTU_MUTATE_RAY_BOX_TWO_AXES
      assign met[u] = there && (there_alone || (below[1:0] == 2'd0 && above[1:0] == 2'd0));
`else
      assign met[u] = there && (there_alone || (below == 3'd0 && above == 3'd0));
`endif
    end
  endgenerate
  pipe_row #(
      .WIDTH(4),
      .DEPTH(SUMS)
  ) row_first (
      .clk_i,
      .enable_i(enable),
      .data_i(first),
      .data_o(first_sums)
  );
  pipe_row #(
      .WIDTH(5 + UNITS),
      .DEPTH(LATENCY - SUMS)
  ) row_met (
      .clk_i,
      .enable_i(enable),
      .data_i({first_sums == 4'd0, first_sums, met}),
      .data_o({begins_q, first_q, met_q})
  );
  pipe_row #(
      .WIDTH(SLOT_BITS + 32),
      .DEPTH(LATENCY)
  ) row_leaf (
      .clk_i,
      .enable_i(enable),
      .data_i({slot_o, reference}),
      .data_o({slot_exit, reference_exit})
  );

  // The cycles of a leaf come out in a row; what was met before is kept until the last one.
  logic [15:0] before_q, leaf_met;
  always_comb leaf_met = (begins_q ? 16'd0 : before_q) | (16'(met_q) << first_q);
  always_ff @(posedge clk_i) if (enable) before_q <= leaf_met;

  wire none = leaf_met == 16'd0;
  assign leaves = none ? missed_ready_i : passed_ready_i;
  assign passed_push_o = exit_valid && !none && passed_ready_i;
  assign passed_data_o = {slot_exit, leaf_met, reference_exit};
  assign missed_push_o = exit_valid && none && missed_ready_i;
  assign missed_data_o = slot_exit;

  assign activity_o = exit_valid && !leaves ? `CTU_OUTPUT_FULL : leaf_pop_o || !empty ? `CTU_BUSY : `CTU_IDLE;
endmodule
