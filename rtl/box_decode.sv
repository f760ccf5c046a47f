// box_decode: the boxes of a node's four lanes, or of LANES of them, from their reduced precision.
//
//   latency LATENCY (docs/unit.md: 1 convert, 4 add: 5), any from 0; initiation interval 1; enable_i stops all registers
//   twin    ctu::accel::decode_boxes (model/accel/quantize.h)
//
// Arithmetic: box_decode_plane, 6 times for each lane. Planes by axis and lane as the bytes of a compact node lie in
// memory (model/accel/compact_node.h): plane l of axis a at [BITS * (LANES * a + l) +: BITS], lower ones first; boxes_o as
// those of a node of full precision. Lanes without a child are empty: lower planes infinite, upper ones minus infinite.
`include "float_format.svh"

module box_decode #(
    parameter int BITS = 16,  // of a plane: 16, 12 or 8
    parameter int LATENCY = 5,
    parameter int LANES = 4
) (
    input  logic                    clk_i,
    input  logic                    enable_i,
    input  logic [            95:0] origin_i,     // axis x lowest
    input  logic [            31:0] exponents_i,  // x in bits 0 to 9, y, z
    input  logic [6*LANES*BITS-1:0] planes_i,
    input  logic [       LANES-1:0] empty_i,      // bit lane: no child
    output logic [   192*LANES-1:0] boxes_o
);
  // What no valid image has: exponents above 276.
  wire unused_exponents = &{1'b0, exponents_i[31:29], exponents_i[19], exponents_i[9]};

  logic [LANES-1:0] empty_q;
  pipe_row #(
      .WIDTH(LANES),
      .DEPTH(LATENCY)
  ) row_empty (
      .clk_i,
      .enable_i,
      .data_i(empty_i),
      .data_o(empty_q)
  );

  generate
    for (genvar axis = 0; axis < 3; axis++) begin : g_axis
      for (genvar lane = 0; lane < LANES; lane++) begin : g_lane
        localparam int LOWER = LANES * axis + lane;
        localparam int UPPER = 3 * LANES + LOWER;
        logic [31:0] lower, upper;
        box_decode_plane #(
            .BITS(BITS),
            .LATENCY(LATENCY),
            .UPPER(1'b0)
        ) decode_lower (
            .clk_i,
            .enable_i,
            .origin_i(origin_i[32*axis+:32]),
            .exponent_i(exponents_i[10*axis+:9]),
            .q_i(planes_i[BITS*LOWER+:BITS]),
            .plane_o(lower)
        );
        box_decode_plane #(
            .BITS(BITS),
            .LATENCY(LATENCY),
            .UPPER(1'b1)
        ) decode_upper (
            .clk_i,
            .enable_i,
            .origin_i(origin_i[32*axis+:32]),
            .exponent_i(exponents_i[10*axis+:9]),
            .q_i(planes_i[BITS*UPPER+:BITS]),
            .plane_o(upper)
        );
        assign boxes_o[32*LOWER+:32] = empty_q[lane] ? `FLOAT_PLUS_INFINITY : lower;
        assign boxes_o[32*UPPER+:32] = empty_q[lane] ? `FLOAT_MINUS_INFINITY : upper;
      end
    end
  endgenerate
endmodule
