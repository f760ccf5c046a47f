// hit_update: writes the best hit of a context, nearer first, equal t to the lower primitive. After the last triangle
// of a leaf the ray goes on to the stack, or is finished if any hit is enough and it has one.
//
//   latency LATENCY from the leaf's last outcome, one outcome a cycle
//   twin    model/pipeline/hit_update.h, intersect::replaces (model/intersect/ray.h)
//   stated  docs/unit.md
//
// Arithmetic: t < best.t, or t == best.t (zeros equal) and primitive < best.primitive. The best hit is read, compared
// and written in the cycle in which the outcome is popped, so outcomes of one leaf can follow each other without
// forwarding; what the registers hold is the token alone.
`include "tokens.svh"

module hit_update #(
    parameter int SLOT_BITS = 5,
    parameter int LATENCY = 2,
    parameter bit HAS_MISSED = 1'b0  // leaves come that have nothing to test
) (
    input  logic                                    clk_i,
    input  logic                                    rst_i,
    input  logic                                    tested_valid_i,
    input  logic [SLOT_BITS+`CTU_TESTED_FIELDS-1:0] tested_data_i,
    output logic                                    tested_pop_o,
    // Contexts whose leaf had nothing to test, from primitive_cull; they go first.
    input  logic                                    missed_valid_i,
    input  logic [                   SLOT_BITS-1:0] missed_data_i,
    output logic                                    missed_pop_o,
    input  logic                                    done_ready_i,
    output logic                                    done_push_o,
    output logic [                     SLOT_BITS:0] done_data_o,       // a leaf done
    // The best hit of the outcome's context: read, and written in the same cycle.
    output logic [                   SLOT_BITS-1:0] best_slot_o,
    input  logic [                            31:0] best_t_i,
    input  logic [                            31:0] best_primitive_i,  // all ones: no hit yet
    input  logic                                    best_any_hit_i,    // any hit is enough for this ray
    output logic                                    best_write_o,
    output logic [                            31:0] best_t_o,
    output logic [                            31:0] best_u_o,
    output logic [                            31:0] best_v_o,
    output logic [                            31:0] best_primitive_o,
    output logic [                             3:0] activity_o
);
  logic [3:0] unused_index;
  logic last, hit;
  logic [SLOT_BITS-1:0] tested_slot;
  assign {tested_slot, unused_index, last, hit, best_t_o, best_u_o, best_v_o, best_primitive_o} = tested_data_i;
  wire missed = HAS_MISSED && missed_valid_i;
  assign best_slot_o = missed ? missed_data_i : tested_slot;
  wire unused_missed = &{1'b0, missed_valid_i, missed_data_i};

  logic nearer, equal, unused_unordered, replaces, has_hit;
  float_compare compare (
      .a_i(best_t_o),
      .b_i(best_t_i),
      .less_o(nearer),
      .equal_o(equal),
      .unordered_o(unused_unordered)
  );
  always_comb begin
    replaces = hit && !missed && (nearer || (equal && best_primitive_o < best_primitive_i));
`ifdef CTU_MUTATE_HIT_LATER_WINS
    replaces = hit && !missed && (nearer || equal);
`endif
    has_hit = (replaces ? best_primitive_o : best_primitive_i) != 32'hffffffff;
`ifdef CTU_MUTATE_HIT_BEFORE_UPDATE
    has_hit = best_primitive_i != 32'hffffffff;
`endif
  end
  assign best_write_o = tested_pop_o && replaces;

  logic can_enter, enable, empty, unused_start, unused_exit_valid;  // a token starts while it is popped
  assign missed_pop_o = missed && can_enter;
  assign tested_pop_o = tested_valid_i && can_enter && !missed;
  pipe_control #(
      .LATENCY(LATENCY)
  ) control (
      .clk_i,
      .rst_i,
      .enter_i(missed_pop_o || (tested_pop_o && last)),
      .occupies_i(1'b1),
      .ready_i(done_ready_i),
      .can_enter_o(can_enter),
      .start_o(unused_start),
      .enable_o(enable),
      .exit_valid_o(unused_exit_valid),
      .exit_o(done_push_o),
      .empty_o(empty)
  );
  pipe_row #(
      .WIDTH(SLOT_BITS + 1),
      .DEPTH(LATENCY)
  ) row_done (
      .clk_i,
      .enable_i(enable),
      .data_i({best_slot_o, best_any_hit_i && has_hit}),
      .data_o(done_data_o)
  );

  assign activity_o = !enable ? `CTU_OUTPUT_FULL : missed_pop_o || tested_pop_o || !empty ? `CTU_BUSY : `CTU_IDLE;
endmodule
