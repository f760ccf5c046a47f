// slab_overlap: the latest of four begins and the earliest of four ends, and whether the one is not behind the other.
//
//   latency LATENCY (docs/unit.md: 3), any from 0; initiation interval 1; enable_i stops all registers
//   twin    the last step of ctu::intersect::slab_test (model/intersect/slab_test.h) and of ctu::cull::packet::PacketSlabs
//
// Arithmetic: t0 = max(begin, slabs...), t1 = min(end, slabs...); float_min_max, float_compare. Vectors of three hold axis
// x in the lowest 32 bits.
module slab_overlap #(
    parameter int LATENCY = 3
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] begin_i,
    input  logic [95:0] slab_begins_i,
    input  logic [31:0] end_i,
    input  logic [95:0] slab_ends_i,
    output logic [31:0] t0_o,
    output logic [31:0] t1_o,
    output logic        hit_o
);
  // Registers behind the three steps.
  localparam int REGISTERS_1 = LATENCY / 3;
  localparam int REGISTERS_2 = 2 * LATENCY / 3 - LATENCY / 3;
  localparam int REGISTERS_3 = LATENCY - 2 * LATENCY / 3;

  // 1, 2: the latest entry and the earliest exit, by pairs.
  logic [31:0] entry_a, entry_b, exit_a, exit_b;
  float_min_max max_a (
      .a_i(begin_i),
      .b_i(slab_begins_i[31:0]),
      .max_i(1'b1),
      .result_o(entry_a)
  );
  float_min_max max_b (
      .a_i(slab_begins_i[63:32]),
      .b_i(slab_begins_i[95:64]),
      .max_i(1'b1),
      .result_o(entry_b)
  );
  float_min_max min_a (
      .a_i(end_i),
      .b_i(slab_ends_i[31:0]),
      .max_i(1'b0),
      .result_o(exit_a)
  );
  float_min_max min_b (
      .a_i(slab_ends_i[63:32]),
      .b_i(slab_ends_i[95:64]),
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
