// sphere_test: the spheres among a leaf's primitives, which triangle_test hands on untested; outcomes of triangles pass
// by.
//
//   in   tested   outcomes of triangle_test, in order
//   out  outcome  the same, those of spheres with their own
//   latency LATENCY, from 1; one outcome a cycle
//   twin    model/pipeline/sphere_test.h; arithmetic: sphere_intersect.sv
//   stated  docs/unit.md
//
// Reads of the context, in the cycle in which an outcome is taken: ray, best t, and the sphere in the leaf's bytes, which
// stay until the context asks for its next leaf.
`include "tokens.svh"

module sphere_test #(
    parameter int SLOT_BITS = 5,
    parameter int LATENCY = 89
) (
    input  logic                                    clk_i,
    input  logic                                    rst_i,
    input  logic                                    tested_valid_i,
    input  logic [SLOT_BITS+`CTU_TESTED_FIELDS-1:0] tested_data_i,
    output logic                                    tested_pop_o,
    input  logic                                    outcome_ready_i,
    output logic                                    outcome_push_o,
    output logic [SLOT_BITS+`CTU_TESTED_FIELDS-1:0] outcome_data_o,

    // The context and its leaf.
    output logic [SLOT_BITS-1:0] slot_o,
    output logic [          3:0] index_o,          // of the sphere within the leaf
    input  logic [         95:0] ray_origin_i,     // x in the lowest bits
    input  logic [         95:0] ray_direction_i,
    input  logic [         31:0] ray_tmin_i,
    input  logic [         31:0] best_t_i,
    input  logic [         95:0] centre_i,
    input  logic [         31:0] radius_i,

    output logic [3:0] activity_o
);
  localparam int TOKEN = SLOT_BITS + `CTU_TESTED_FIELDS;

  assign slot_o = tested_data_i[TOKEN-1-:SLOT_BITS];
  assign index_o = tested_data_i[TOKEN-SLOT_BITS-1-:4];

  logic enter, enable, exit_valid, empty, unused_start;
  pipe_control #(
      .LATENCY(LATENCY)
  ) control (
      .clk_i,
      .rst_i,
      .enter_i(tested_pop_o),
      .occupies_i(1'b1),
      .ready_i(outcome_ready_i),
      .can_enter_o(enter),
      .start_o(unused_start),
      .enable_o(enable),
      .exit_valid_o(exit_valid),
      .exit_o(outcome_push_o),
      .empty_o(empty)
  );
  assign tested_pop_o = tested_valid_i && enter;

  logic hit;
  logic [31:0] t;
  sphere_intersect #(
      .LATENCY(LATENCY)
  ) tester (
      .clk_i,
      .enable_i(enable),
      .origin_i(ray_origin_i),
      .direction_i(ray_direction_i),
      .tmin_i(ray_tmin_i),
      .tmax_i(best_t_i),
      .centre_i,
      .radius_i,
      .hit_o(hit),
      .t_o(t)
  );
  logic [TOKEN-1:0] token;
  pipe_row #(
      .WIDTH(TOKEN),
      .DEPTH(LATENCY)
  ) row_token (
      .clk_i,
      .enable_i(enable),
      .data_i(tested_data_i),
      .data_o(token)
  );
  // A sphere is its own outcome: u and v are 0, and its primitive loses the bit that says what it is.
  assign outcome_data_o = token[31] ? {token[TOKEN-1:129], hit, t, 64'd0, 1'b0, token[30:0]} : token;

  assign activity_o = exit_valid && !outcome_ready_i ? `CTU_OUTPUT_FULL
                      : tested_pop_o || !empty ? `CTU_BUSY : `CTU_IDLE;
endmodule
