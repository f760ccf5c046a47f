// packet_slab_axis: where the rays of a packet are between the two face planes of one box on one axis: when some ray may
// be, and when every ray is, enclosed by bounds rounded outwards.
//
//   latency SUBTRACT_LATENCY + MULTIPLY_LATENCY, initiation interval 1; enable_i stops all registers
//   twin    ctu::cull::packet::PacketSlabs::stay (model/cull/packet/packet_slabs.h)
//
// Arithmetic: an axis along which all rays move down is mirrored (signs flipped, exact); slab_bound gives the bounds, each
// with the origin and the reciprocal that make it an outer one for all rays. Along an axis on which none moves the
// origins say whether all are outside (crossed bounds), all inside (open bounds), or neither is known: then some ray
// may always be inside and every ray never is. Nor is more known where rays go both ways, or some go and some stand, but
// for an empty box.
`include "float_format.svh"

module packet_slab_axis #(
    parameter int SUBTRACT_LATENCY = 4,
    parameter int MULTIPLY_LATENCY = 4
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] lo_i,
    input  logic [31:0] hi_i,
    input  logic [31:0] origin_lo_i,
    input  logic [31:0] origin_hi_i,
    input  logic [31:0] rcp_lo_i,     // of the rays that move
    input  logic [31:0] rcp_hi_i,
    input  logic        up_i,         // some ray moves so
    input  logic        down_i,
    input  logic        still_i,
    output logic [31:0] from_o,       // some ray may be inside between from_o and to_o
    output logic [31:0] to_o,
    output logic [31:0] all_from_o,   // every ray is between all_from_o and all_to_o
    output logic [31:0] all_to_o
);
  logic [31:0] near_plane, far_plane, first_origin, last_origin, rcp_smaller, rcp_larger;
  always_comb begin
    near_plane = down_i ? {~hi_i[31], hi_i[30:0]} : lo_i;
    far_plane = down_i ? {~lo_i[31], lo_i[30:0]} : hi_i;
    first_origin = down_i ? {~origin_hi_i[31], origin_hi_i[30:0]} : origin_lo_i;
    last_origin = down_i ? {~origin_lo_i[31], origin_lo_i[30:0]} : origin_hi_i;
    rcp_smaller = down_i ? {~rcp_hi_i[31], rcp_hi_i[30:0]} : rcp_lo_i;
    rcp_larger = down_i ? {~rcp_lo_i[31], rcp_lo_i[30:0]} : rcp_hi_i;
`ifdef CTU_MUTATE_PACKET_ORIGINS_SWAPPED
    first_origin = {origin_lo_i[31] ^ down_i, origin_lo_i[30:0]};
    last_origin = {origin_hi_i[31] ^ down_i, origin_hi_i[30:0]};
`endif
  end

  logic [31:0] rcp_smaller_q, rcp_larger_q;
  pipe_row #(
      .WIDTH(64),
      .DEPTH(SUBTRACT_LATENCY)
  ) row_reciprocals (
      .clk_i,
      .enable_i,
      .data_i({rcp_smaller, rcp_larger}),
      .data_o({rcp_smaller_q, rcp_larger_q})
  );

  // Without one direction for all: what the origins say, and whether there is a slab.
  logic all_below, all_above, starts_below, ends_above, empty;
  logic [9:0] unused_compare;
  float_compare compare_below (
      .a_i(origin_hi_i),
      .b_i(lo_i),
      .less_o(all_below),
      .equal_o(unused_compare[0]),
      .unordered_o(unused_compare[1])
  );
  float_compare compare_above (
      .a_i(hi_i),
      .b_i(origin_lo_i),
      .less_o(all_above),
      .equal_o(unused_compare[2]),
      .unordered_o(unused_compare[3])
  );
  float_compare compare_lowest (
      .a_i(origin_lo_i),
      .b_i(lo_i),
      .less_o(starts_below),
      .equal_o(unused_compare[4]),
      .unordered_o(unused_compare[5])
  );
  float_compare compare_highest (
      .a_i(hi_i),
      .b_i(origin_hi_i),
      .less_o(ends_above),
      .equal_o(unused_compare[6]),
      .unordered_o(unused_compare[7])
  );
  float_compare compare_faces (
      .a_i(hi_i),
      .b_i(lo_i),
      .less_o(empty),
      .equal_o(unused_compare[8]),
      .unordered_o(unused_compare[9])
  );
  wire one_way = up_i != down_i && !still_i;
  wire all_still = still_i && !up_i && !down_i;
  wire all_outside = all_still ? all_below || all_above : empty;
  wire all_inside = all_still && !starts_below && !ends_above;
  logic one_way_q, outside_q, inside_q;
  pipe_row #(
      .WIDTH(3),
      .DEPTH(SUBTRACT_LATENCY + MULTIPLY_LATENCY)
  ) row_known (
      .clk_i,
      .enable_i,
      .data_i({one_way, all_outside, all_inside}),
      .data_o({one_way_q, outside_q, inside_q})
  );

  // from, to, all_from, all_to.
  logic [127:0] times;
  generate
    for (genvar bound = 0; bound < 4; bound++) begin : g_bound
      localparam bit IS_FAR = bound[0];
      localparam bit OF_ALL = bound[1];
      logic [31:0] moving;
      slab_bound #(
          .SUBTRACT_LATENCY(SUBTRACT_LATENCY),
          .MULTIPLY_LATENCY(MULTIPLY_LATENCY),
          .ROUNDS_UP(IS_FAR != OF_ALL)
      ) moving_bound (
          .clk_i,
          .enable_i,
          .plane_i(IS_FAR ? far_plane : near_plane),
          .origin_i(IS_FAR != OF_ALL ? first_origin : last_origin),
          .rcp_smaller_i(rcp_smaller_q),
          .rcp_larger_i(rcp_larger_q),
          .time_o(moving)
      );
      wire open = OF_ALL ? inside_q : !outside_q;
      assign times[32*bound+:32] =
          one_way_q ? moving : open != IS_FAR ? `FLOAT_MINUS_INFINITY : `FLOAT_PLUS_INFINITY;
    end
  endgenerate
  assign {all_to_o, all_from_o, to_o, from_o} = times;
endmodule
