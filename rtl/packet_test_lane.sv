// packet_test_lane: all rays of a packet against one box; the datapath of one of packet_cull's lanes.
//
//   latency SUBTRACT_LATENCY + MULTIPLY_LATENCY + COMPARE_LATENCY (docs/unit.md: 4 + 4 + 3), initiation interval 1;
//           enable_i stops all registers
//   twin    one lane of ctu::cull::packet::PacketSlabs::test (model/cull/packet/packet_slabs.h)
//
// Arithmetic: packet_slab_axis on each axis, then slab_overlap, of some ray and of every ray. Bounds of the packet are
// laid out as packet_bounds.svh says; vectors of three hold axis x in the lowest 32 bits.
`include "packet_bounds.svh"

module packet_test_lane #(
    parameter int SUBTRACT_LATENCY = 4,
    parameter int MULTIPLY_LATENCY = 4,
    parameter int COMPARE_LATENCY = 3
) (
    input  logic                        clk_i,
    input  logic                        enable_i,
    input  logic [                95:0] lo_i,
    input  logic [                95:0] hi_i,
    input  logic [`CTU_PACKET_BITS-1:0] bounds_i,
    output logic                        hit_o,     // some ray may meet the box
    output logic                        sure_o,    // every ray meets it, by its own slab test
    output logic [                31:0] t0_o       // not after the first meeting of any ray
);
  logic [95:0] from, to, all_from, all_to;
  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_axis
      localparam int AXIS = `CTU_PACKET_AXIS * axis;
      packet_slab_axis #(
          .SUBTRACT_LATENCY(SUBTRACT_LATENCY),
          .MULTIPLY_LATENCY(MULTIPLY_LATENCY)
      ) slab (
          .clk_i,
          .enable_i,
          .lo_i(lo_i[32*axis+:32]),
          .hi_i(hi_i[32*axis+:32]),
          .origin_lo_i(bounds_i[AXIS+`CTU_PACKET_ORIGIN_LO+:32]),
          .origin_hi_i(bounds_i[AXIS+`CTU_PACKET_ORIGIN_HI+:32]),
          .rcp_lo_i(bounds_i[AXIS+`CTU_PACKET_RCP_LO+:32]),
          .rcp_hi_i(bounds_i[AXIS+`CTU_PACKET_RCP_HI+:32]),
          .up_i(bounds_i[AXIS+`CTU_PACKET_UP]),
          .down_i(bounds_i[AXIS+`CTU_PACKET_DOWN]),
          .still_i(bounds_i[AXIS+`CTU_PACKET_STILL]),
          .from_o(from[32*axis+:32]),
          .to_o(to[32*axis+:32]),
          .all_from_o(all_from[32*axis+:32]),
          .all_to_o(all_to[32*axis+:32])
      );
    end
  endgenerate

  logic [31:0] begins, ends, all_begun, first_end;
  pipe_row #(
      .WIDTH(128),
      .DEPTH(SUBTRACT_LATENCY + MULTIPLY_LATENCY)
  ) row_intervals (
      .clk_i,
      .enable_i,
      .data_i({bounds_i[`CTU_PACKET_BEGINS+:32], bounds_i[`CTU_PACKET_ENDS+:32], bounds_i[`CTU_PACKET_ALL_BEGUN+:32],
               bounds_i[`CTU_PACKET_FIRST_END+:32]}),
      .data_o({begins, ends, all_begun, first_end})
  );
  logic [95:0] unused_times;
  slab_overlap #(
      .LATENCY(COMPARE_LATENCY)
  ) some_ray (
      .clk_i,
      .enable_i,
      .begin_i(begins),
      .slab_begins_i(from),
      .end_i(ends),
      .slab_ends_i(to),
      .t0_o,
      .t1_o(unused_times[31:0]),
      .hit_o
  );
  slab_overlap #(
      .LATENCY(COMPARE_LATENCY)
  ) every_ray (
      .clk_i,
      .enable_i,
      .begin_i(all_begun),
      .slab_begins_i(all_from),
      .end_i(first_end),
      .slab_ends_i(all_to),
      .t0_o(unused_times[63:32]),
      .t1_o(unused_times[95:64]),
      .hit_o(sure_o)
  );
endmodule
