// packet_join: the bounds of a packet that a ray has joined; combinational.
//
//   twin    ctu::cull::packet::PacketSlabs::add (model/cull/packet/packet_slabs.h)
//
// Bounds are laid out as packet_bounds.svh says. Arithmetic: float_min_max. Vectors of three hold axis x in the lowest
// bits.
`include "float_format.svh"
`include "packet_bounds.svh"

module packet_join (
    input  logic                        first_i,          // there was no ray before
    input  logic [`CTU_PACKET_BITS-1:0] before_i,
    input  logic [                95:0] origin_i,
    input  logic [                95:0] rcp_down_i,
    input  logic [                95:0] rcp_up_i,
    input  logic [                 2:0] zero_axes_i,
    input  logic [                 2:0] negative_axes_i,
    input  logic [                31:0] tmin_i,
    input  logic [                31:0] tmax_i,
    output logic [`CTU_PACKET_BITS-1:0] after_o
);
  generate
    // Bounds by pairs, the least and the greatest: of origins and reciprocals by axis, of begins, of ends.
    for (genvar pair = 0; pair < 8; pair++) begin : g_pair
      localparam int AXIS = pair / 2;
      localparam bit OF_RCP = pair < 6 && pair[0];
      localparam int LEAST = pair == 6 ? `CTU_PACKET_BEGINS : pair == 7 ? `CTU_PACKET_FIRST_END :
                             `CTU_PACKET_AXIS * AXIS + (OF_RCP ? `CTU_PACKET_RCP_LO : `CTU_PACKET_ORIGIN_LO);
      localparam int GREATEST = pair == 6 ? `CTU_PACKET_ALL_BEGUN : pair == 7 ? `CTU_PACKET_ENDS :
                                `CTU_PACKET_AXIS * AXIS + (OF_RCP ? `CTU_PACKET_RCP_HI : `CTU_PACKET_ORIGIN_HI);
      logic [31:0] lower, upper, least, greatest, new_least, new_greatest;
      logic takes_part;
      if (pair == 6) begin : g_begins
        assign lower = tmin_i;
        assign upper = tmin_i;
        assign takes_part = 1'b1;
      end else if (pair == 7) begin : g_ends
        assign lower = tmax_i;
        assign upper = tmax_i;
        assign takes_part = 1'b1;
      end else if (OF_RCP) begin : g_reciprocals
        assign lower = rcp_down_i[32*AXIS+:32];
        assign upper = rcp_up_i[32*AXIS+:32];
        assign takes_part = !zero_axes_i[AXIS];
      end else begin : g_origins
        assign lower = origin_i[32*AXIS+:32];
        assign upper = origin_i[32*AXIS+:32];
        assign takes_part = 1'b1;
      end
      assign least = first_i ? `FLOAT_PLUS_INFINITY : before_i[LEAST+:32];
      assign greatest = first_i ? `FLOAT_MINUS_INFINITY : before_i[GREATEST+:32];
      float_min_max min (
          .a_i(least),
          .b_i(lower),
          .max_i(1'b0),
          .result_o(new_least)
      );
      float_min_max max (
          .a_i(greatest),
          .b_i(upper),
          .max_i(1'b1),
          .result_o(new_greatest)
      );
      assign after_o[LEAST+:32] = takes_part ? new_least : least;
      assign after_o[GREATEST+:32] = takes_part ? new_greatest : greatest;
    end
    for (genvar axis = 0; axis < 3; axis++) begin : g_axis
      wire [2:0] ways = first_i ? 3'd0 : before_i[`CTU_PACKET_AXIS*axis+`CTU_PACKET_UP+:3];
      wire [2:0] way = zero_axes_i[axis] ? 3'b100 : negative_axes_i[axis] ? 3'b010 : 3'b001;
      assign after_o[`CTU_PACKET_AXIS*axis+`CTU_PACKET_UP+:3] = ways | way;
    end
  endgenerate
endmodule
