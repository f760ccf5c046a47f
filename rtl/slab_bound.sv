// slab_bound: a bound of the t at which a ray meets a plane across an axis, along which the ray moves up; or at which any
// ray of a packet does, with the origin and the reciprocals that make it a bound for all of them.
//
//   latency SUBTRACT_LATENCY + MULTIPLY_LATENCY, initiation interval 1; enable_i stops all registers
//   twin    one bound of ctu::intersect::slab_test (model/intersect/slab_test.h) and of ctu::cull::packet::PacketSlabs
//
// Arithmetic: the distance of plane and origin, rounded in the bound's direction, times the reciprocal that makes the
// product an outer bound, rounded again. A zero distance gives t = +0 whatever the reciprocal.
`include "float_format.svh"

module slab_bound #(
    parameter int SUBTRACT_LATENCY = 4,
    parameter int MULTIPLY_LATENCY = 4,
    parameter bit ROUNDS_UP = 1'b0
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] plane_i,
    input  logic [31:0] origin_i,
    input  logic [31:0] rcp_smaller_i,  // SUBTRACT_LATENCY later
    input  logic [31:0] rcp_larger_i,
    output logic [31:0] time_o
);
  localparam logic [1:0] ROUND = ROUNDS_UP ? `FLOAT_ROUND_UP : `FLOAT_ROUND_DOWN;

  logic [31:0] distance, rcp, product;
  logic on_plane, on_plane_q;
  float_add #(
      .LATENCY(SUBTRACT_LATENCY)
  ) subtract (
      .clk_i,
      .enable_i,
      .a_i(plane_i),
      .b_i(origin_i),
      .subtract_i(1'b1),
      .round_i(ROUND),
      .result_o(distance)
  );
  // Of a positive distance the smaller reciprocal gives the lower bound, of a negative one the larger.
`ifdef CTU_MUTATE_RECIPROCAL_BY_DIRECTION
  assign rcp = ROUNDS_UP ? rcp_larger_i : rcp_smaller_i;
`else
  assign rcp = distance[31] == ROUNDS_UP ? rcp_smaller_i : rcp_larger_i;
`endif
  assign on_plane = distance[30:0] == 31'd0;
  float_mul #(
      .LATENCY(MULTIPLY_LATENCY)
  ) multiply (
      .clk_i,
      .enable_i,
      .a_i(distance),
      .b_i(rcp),
      .round_i(ROUND),
      .result_o(product)
  );
  pipe_row #(
      .WIDTH(1),
      .DEPTH(MULTIPLY_LATENCY)
  ) row_on_plane (
      .clk_i,
      .enable_i,
      .data_i(on_plane),
      .data_o(on_plane_q)
  );
`ifdef CTU_MUTATE_ZERO_DISTANCE
  wire unused_on_plane = on_plane_q;
  assign time_o = product;
`else
  assign time_o = on_plane_q ? 32'd0 : product;
`endif
endmodule
