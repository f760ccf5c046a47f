// child_sort: the surviving lanes by (t0, lane), nearest first.
//
//   latency LATENCY, initiation interval 1
//   twin    model/pipeline/child_sort.h, ExecSource::child_order (model/pipeline/exec_source.cpp)
//   stated  docs/unit.md
//
// Arithmetic: zeros are equal whatever their signs, and of equal t0 the lower lane comes first. t0 is never a NaN.
// Three steps: six comparisons, each lane's place by counting who comes before it, the lanes at their places; the
// LATENCY registers are spread over the places behind each of them, the last place first. Places of order that no
// survivor has are 0.
`include "tokens.svh"

module child_sort #(
    parameter int SLOT_BITS = 5,
    parameter int LATENCY = 3
) (
    input  logic                                  clk_i,
    input  logic                                  rst_i,
    input  logic                                  survivors_valid_i,
    input  logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] survivors_data_i,   // a node; of its order and asked nothing is read
    output logic                                  survivors_pop_o,
    input  logic                                  sorted_ready_i,
    output logic                                  sorted_push_o,
    output logic [SLOT_BITS+`CTU_NODE_FIELDS-1:0] sorted_data_o,      // a node, with its order; asked is 0
    output logic [                 SLOT_BITS-1:0] times_slot_o,
    input  logic [                         127:0] times_t0_i,         // of the four lanes
    output logic [                           3:0] activity_o
);
  // Registers behind the three steps.
  localparam int REGISTERS_1 = LATENCY / 3;
  localparam int REGISTERS_2 = 2 * LATENCY / 3 - LATENCY / 3;
  localparam int REGISTERS_3 = LATENCY - 2 * LATENCY / 3;

  logic [3:0] hits, survivors;
  logic [11:0] unused_fields;
  assign {times_slot_o, hits, survivors, unused_fields} = survivors_data_i;

  logic can_enter, enable, empty, unused_start, unused_exit_valid;  // a token starts while it is popped
  assign survivors_pop_o = survivors_valid_i && can_enter;
  pipe_control #(
      .LATENCY(LATENCY)
  ) control (
      .clk_i,
      .rst_i,
      .enter_i(survivors_pop_o),
      .occupies_i(1'b1),
      .ready_i(sorted_ready_i),
      .can_enter_o(can_enter),
      .start_o(unused_start),
      .enable_o(enable),
      .exit_valid_o(unused_exit_valid),
      .exit_o(sorted_push_o),
      .empty_o(empty)
  );

  logic [SLOT_BITS-1:0] slot_q;
  logic [3:0] hits_q, survivors_q;
  pipe_row #(
      .WIDTH(SLOT_BITS + 8),
      .DEPTH(LATENCY)
  ) row_token (
      .clk_i,
      .enable_i(enable),
      .data_i({times_slot_o, hits, survivors}),
      .data_o({slot_q, hits_q, survivors_q})
  );

  // 1: who comes before whom: bit 4a + b, lane a comes before lane b, both surviving.
  logic [15:0] first, first_q1;
  generate
    for (genvar a = 0; a < 4; a++) begin : g_lane
      assign first[5*a] = 1'b0;
      for (genvar b = a + 1; b < 4; b++) begin : g_other
        logic later, equal, unused_unordered;  // lane a is
        float_compare compare (
            .a_i(times_t0_i[32*b+:32]),
            .b_i(times_t0_i[32*a+:32]),
            .less_o(later),
            .equal_o(equal),
            .unordered_o(unused_unordered)
        );
`ifdef CTU_MUTATE_SORT_LANE_TIES
        wire b_first = later || equal;
`else
        wire b_first = later;
        wire unused_equal = equal;
`endif
`ifdef CTU_MUTATE_SORT_DEAD_COUNT
        assign first[4*a+b] = !b_first;
        assign first[4*b+a] = b_first;
`else
        assign first[4*a+b] = survivors[a] && survivors[b] && !b_first;
        assign first[4*b+a] = survivors[a] && survivors[b] && b_first;
`endif
      end
    end
  endgenerate
  logic [3:0] survivors_q1;
  pipe_row #(
      .WIDTH(20),
      .DEPTH(REGISTERS_1)
  ) row_1 (
      .clk_i,
      .enable_i(enable),
      .data_i({first, survivors}),
      .data_o({first_q1, survivors_q1})
  );

  // 2: places.
  logic [7:0] place, place_q2;
  logic [3:0] survivors_q2;
  always_comb begin
    for (int lane = 0; lane < 4; lane++) begin
      place[2*lane+:2] = {1'b0, first_q1[lane]} + {1'b0, first_q1[4+lane]} + {1'b0, first_q1[8+lane]} +
                         {1'b0, first_q1[12+lane]};
    end
  end
  pipe_row #(
      .WIDTH(12),
      .DEPTH(REGISTERS_2)
  ) row_2 (
      .clk_i,
      .enable_i(enable),
      .data_i({place, survivors_q1}),
      .data_o({place_q2, survivors_q2})
  );

  // 3: lanes at their places.
  logic [7:0] order, order_q3;
  always_comb begin
    order = 8'd0;
    for (int lane = 0; lane < 4; lane++) begin
      for (int at = 0; at < 4; at++) begin
        if (survivors_q2[lane] && place_q2[2*lane+:2] == 2'(at)) order[2*at+:2] = 2'(lane);
      end
    end
  end
  pipe_row #(
      .WIDTH(8),
      .DEPTH(REGISTERS_3)
  ) row_3 (
      .clk_i,
      .enable_i(enable),
      .data_i(order),
      .data_o(order_q3)
  );
  assign sorted_data_o = {slot_q, hits_q, survivors_q, order_q3, 4'd0};

  assign activity_o = !enable ? `CTU_OUTPUT_FULL : survivors_pop_o || !empty ? `CTU_BUSY : `CTU_IDLE;
endmodule
