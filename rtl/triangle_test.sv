// triangle_test: the triangles of a leaf, one after the other, into one watertight triangle tester. Spheres go through it
// untested, primitives that primitive_cull has thrown away not at all.
//
//   in   leaf    a context and the leaf whose bytes have come
//   out  tested  one outcome for each primitive; t, u, v are +0 without a hit
//   latency LATENCY + interval_i - 1, from 1; a triangle each interval_i cycles
//   twin    model/pipeline/triangle_test.h; arithmetic: triangle_intersect.sv
//   stated  docs/unit.md
//
// Reads of the context: the best t in the cycle in which a triangle takes the entrance, ray and triangle in the last
// one in which it keeps it; both are the same cycle where interval_i is 1. Ray and triangle stay while the leaf is
// tested, the best t does not, so that is what the entrance holds.
`include "tokens.svh"

module triangle_test #(
    parameter int SLOT_BITS = 5,
    parameter int LATENCY = 45,
    parameter bit CULLED = 1'b0,   // leaves come from primitive_cull
    parameter bit SPHERES = 1'b0   // some primitives are spheres
) (
    input  logic clk_i,
    input  logic rst_i,
    input  logic [6:0] interval_i,  // strap: 1 .. 100

    input  logic                  leaf_valid_i,
    input  logic [SLOT_BITS+31:0] leaf_data_i,
    input  logic [          15:0] leaf_met_i,    // with CULLED: the primitives to test
    output logic                  leaf_pop_o,

    input  logic                                  tested_ready_i,
    output logic                                  tested_push_o,
    output logic [SLOT_BITS+`CTU_TESTED_FIELDS-1:0] tested_data_o,

    // best hits
    output logic [SLOT_BITS-1:0] best_slot_o,
    input  logic [         31:0] best_t_i,

    // rays
    output logic [SLOT_BITS-1:0] ray_slot_o,
    input  logic [         95:0] ray_origin_i,       // x in the lowest bits
    input  logic [         31:0] ray_direction_z_i,  // the component along kz
    input  logic [          1:0] ray_kx_i,
    input  logic [          1:0] ray_ky_i,
    input  logic [          1:0] ray_kz_i,
    input  logic [         31:0] ray_sx_i,
    input  logic [         31:0] ray_sy_i,
    input  logic [         31:0] ray_tmin_i,

    // the leaf's bytes in leaf_fetch
    output logic [SLOT_BITS-1:0] triangle_slot_o,
    output logic [          3:0] triangle_index_o,  // within the leaf
    input  logic [        319:0] triangle_i,        // its 40 bytes: three vertices, primitive

    output logic [3:0] activity_o
);
  // The primitive that takes the entrance: the first one of the next leaf, or the next one of this leaf; and what of the
  // leaf is behind it, as a number or, with CULLED, one by one.
  localparam int REST = CULLED ? 16 : 4;
  logic [SLOT_BITS-1:0] slot_q, entering_slot;
  logic [3:0] index_q, entering_index;
  logic [REST-1:0] rest_q, entering_rest;
  logic [31:0] best_t_q;
  logic can_enter, waits, enter, start, enable, exit_valid, leaves, empty;
  always_comb begin
    entering_slot = rest_q == '0 ? leaf_data_i[SLOT_BITS+31:32] : slot_q;
    waits = rest_q != '0 || leaf_valid_i;
    enter = waits && can_enter;
    leaf_pop_o = enter && rest_q == '0;
  end
  wire unused_reference = &{1'b0, leaf_data_i[31:0], leaf_met_i};
  generate
    if (CULLED) begin : g_culled
      wire [15:0] waiting = rest_q == '0 ? leaf_met_i : rest_q;
      always_comb begin
        entering_index = 4'd0;
        for (int i = 15; i >= 0; i--) if (waiting[i]) entering_index = 4'(i);
        entering_rest = waiting & (waiting - 16'd1);
      end
    end else begin : g_all
      always_comb begin
        entering_index = rest_q == '0 ? 4'd0 : index_q + 4'd1;
        entering_rest = rest_q == '0 ? leaf_data_i[30:27] : rest_q - 4'd1;
      end
    end
  endgenerate

  always_ff @(posedge clk_i) begin
    if (rst_i) rest_q <= '0;
    else if (enter) rest_q <= entering_rest;
  end
  always_ff @(posedge clk_i) begin
    if (enter) begin
      slot_q <= entering_slot;
      index_q <= entering_index;
      best_t_q <= best_t_i;
    end
  end

  pipe_control #(
      .LATENCY(LATENCY),
      .OCCUPIES_BITS(7)
  ) control (
      .clk_i,
      .rst_i,
      .enter_i(enter),
      .occupies_i(interval_i),
      .ready_i(tested_ready_i),
      .can_enter_o(can_enter),
      .start_o(start),
      .enable_o(enable),
      .exit_valid_o(exit_valid),
      .exit_o(leaves),
      .empty_o(empty)
  );
  wire unused_start = start;  // whatever the rows take without it is nobody's

  // The triangle at the first register: the one that has kept the entrance, or where that is free the one that enters.
  logic [SLOT_BITS-1:0] slot, exit_slot;
  logic [3:0] index, exit_index;
  logic last, exit_last;
  logic [31:0] tmax, exit_primitive;
  always_comb begin
    slot = can_enter ? entering_slot : slot_q;
    index = can_enter ? entering_index : index_q;
    last = (can_enter ? entering_rest : rest_q) == '0;
`ifdef CTU_MUTATE_TRIANGLE_LAST_EARLY
    last = (can_enter ? entering_rest : rest_q) <= REST'(1);
`endif
    tmax = can_enter ? best_t_i : best_t_q;
`ifdef CTU_MUTATE_BEST_AFTER_INTERVAL
    tmax = best_t_i;
`endif
  end
  assign best_slot_o = entering_slot;
  assign ray_slot_o = slot;
  assign triangle_slot_o = slot;
  assign triangle_index_o = index;

  logic hit;
  logic [31:0] t, u, v;
  triangle_intersect #(
      .LATENCY(LATENCY)
  ) tester (
      .clk_i,
      .enable_i(enable),
      .origin_i(ray_origin_i),
      .direction_z_i(ray_direction_z_i),
      .kx_i(ray_kx_i),
      .ky_i(ray_ky_i),
      .kz_i(ray_kz_i),
      .sx_i(ray_sx_i),
      .sy_i(ray_sy_i),
      .tmin_i(ray_tmin_i),
      .tmax_i(tmax),
      .vertices_i(triangle_i[287:0]),
      .hit_o(hit),
      .t_o(t),
      .u_o(u),
      .v_o(v)
  );
  pipe_row #(
      .WIDTH(SLOT_BITS + 37),
      .DEPTH(LATENCY)
  ) row_token (
      .clk_i,
      .enable_i(enable),
      .data_i({slot, index, last, triangle_i[319:288]}),
      .data_o({exit_slot, exit_index, exit_last, exit_primitive})
  );
  assign tested_push_o = leaves;
  wire sphere = SPHERES && exit_primitive[31];
  assign tested_data_o = {exit_slot, exit_index, exit_last, sphere ? 97'd0 : {hit, t, u, v}, exit_primitive};

  always_comb begin
    activity_o = leaves || enter || !empty ? `CTU_BUSY : `CTU_IDLE;
    if (waits && !enter) activity_o = `CTU_INTERVAL;
    if (exit_valid && !tested_ready_i) activity_o = `CTU_OUTPUT_FULL;
  end
endmodule
