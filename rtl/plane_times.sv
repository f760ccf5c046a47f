// plane_times: the R - 1 inner planes between two faces of a box on one axis, each enclosed by two bounds: where on the
// ray, when the faces are given as times, or where in space.
//
//   latency MULTIPLY_LATENCY + ADD_LATENCY, initiation interval 1; enable_i stops all registers
//   twin    ctu::cull::lerp_planes of all groups (model/cull/plane_times.h)
//
// Arithmetic: plane k is (R-k)/R first + k/R second, each product and the sum rounded down for a lower bound, up for an upper
// one (float_fraction, float_add). Plane k lies at [32 (k-1) +: 32]. No sum is infinity - infinity: a lower bound's
// faces are below +infinity, an upper bound's above -infinity.
`include "float_format.svh"

module plane_times #(
    parameter int R = 4,
    parameter int MULTIPLY_LATENCY = 3,
    parameter int ADD_LATENCY = 4
) (
    input  logic                 clk_i,
    input  logic                 enable_i,
    input  logic [         31:0] first_down_i,
    input  logic [         31:0] first_up_i,
    input  logic [         31:0] second_down_i,
    input  logic [         31:0] second_up_i,
    output logic [32*(R-1)-1:0] down_o,
    output logic [32*(R-1)-1:0] up_o
);
  generate
    for (genvar k = 1; k < R; k++) begin : g_plane
      for (genvar bound = 0; bound < 2; bound++) begin : g_bound
        localparam bit UP = bound[0];
        logic [31:0] first_part, second_part, sum;
        float_fraction #(
            .K(R - k),
            .N(R),
            .UP(UP),
            .LATENCY(MULTIPLY_LATENCY)
        ) first (
            .clk_i,
            .enable_i,
            .a_i(UP ? first_up_i : first_down_i),
            .result_o(first_part)
        );
        float_fraction #(
            .K(k),
            .N(R),
            .UP(UP),
            .LATENCY(MULTIPLY_LATENCY)
        ) second (
            .clk_i,
            .enable_i,
            .a_i(UP ? second_up_i : second_down_i),
            .result_o(second_part)
        );
        float_add #(
            .LATENCY(ADD_LATENCY)
        ) add (
            .clk_i,
            .enable_i,
            .a_i(first_part),
            .b_i(second_part),
            .subtract_i(1'b0),
            .round_i(UP ? `FLOAT_ROUND_UP : `FLOAT_ROUND_DOWN),
            .result_o(sum)
        );
        if (UP) begin : g_up
          assign up_o[32*(k-1)+:32] = sum;
        end else begin : g_down
          assign down_o[32*(k-1)+:32] = sum;
        end
      end
    end
  endgenerate
endmodule
