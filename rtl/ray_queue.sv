// ray_queue: gives each ray of the feed, in order, a free context, and sets up its registers (reciprocal bounds, shear,
// the root). A ray that the unit does not accept goes straight to the result as a miss.
//
//   in   freed         contexts that result_queue has emptied
//   out  to_scheduler  the root of its tree, for each ray
//   out  to_result     rays that visit nothing
//   out  to_packets    with PACKETS instead of to_scheduler: each ray that is valid or the last one of its packet
//   latency interval_i - 1 + LATENCY, one ray each interval_i cycles
//   twin    model/pipeline/ray_queue.h; intersect::prepare_ray, is_valid (model/intersect/ray.h)
//   stated  docs/unit.md
//
// The host holds the next ray with ray_valid_i until ray_take_o. In that cycle its context's registers are written at
// ray_slot_o: of the ray, what the host gives and the signs and axes of its direction (ray_*_o); of the best hit,
// t = tmax, u = v = 0, no primitive. The quotients are written when a valid ray leaves (setup_*_o).
//
// With TREES above 1 a ray names its tree by number. The roots lie in a table, filled before rays come; a ray's root
// (ray_root_o) is read as it is taken and kept with its registers. With one tree there is no table, and its root is 0.
//
// Arithmetic: 1 / d of each axis rounded down and up, +0 where d is zero; d[kx] / d[kz] and d[ky] / d[kz] to nearest.
// These five divisions are given to as many dividers as MIN_INTERVAL needs, in the last cycles that the ray keeps the
// entrance; what is divided in an earlier one waits behind the divider, so that all quotients of a ray stand there as
// it leaves.
`include "tokens.svh"

module ray_queue #(
    parameter int SLOT_BITS = 5,
    parameter int LATENCY = 20,
    parameter int MIN_INTERVAL = 3,
    parameter bit PACKETS = 1'b0,  // rays travel in packets
    parameter int TREES = 1,       // of the image, 1 .. 256
    localparam int TREE_BITS = TREES <= 2 ? 1 : $clog2(TREES)
) (
    input logic clk_i,
    input logic rst_i,

    // Straps.
    input logic [SLOT_BITS:0] contexts_i,  // 1 .. 1 << SLOT_BITS
    input logic [        6:0] interval_i,  // at least MIN_INTERVAL; 5 are always enough

    // The table of roots.
    input logic                 root_write_i,
    input logic [TREE_BITS-1:0] root_tree_i,
    input logic [         31:0] root_i,

    // The feed. Vectors of three hold axis x in the lowest bits.
    input  logic                 ray_valid_i,
    input  logic [         95:0] ray_origin_i,
    input  logic [         95:0] ray_direction_i,
    input  logic [         31:0] ray_tmin_i,
    input  logic [         31:0] ray_tmax_i,
    input  logic                 ray_closes_i,         // with PACKETS: it is the last one of its packet
    input  logic [TREE_BITS-1:0] ray_tree_i,
    output logic                 ray_take_o,
    output logic [SLOT_BITS-1:0] ray_slot_o,
    output logic [         31:0] ray_root_o,
    output logic [          2:0] ray_zero_axes_o,
    output logic [          2:0] ray_negative_axes_o,
    output logic [          1:0] ray_kx_o,
    output logic [          1:0] ray_ky_o,
    output logic [          1:0] ray_kz_o,

    input  logic                    freed_valid_i,
    input  logic [   SLOT_BITS-1:0] freed_data_i,
    output logic                    freed_pop_o,
    input  logic                    to_scheduler_ready_i,
    output logic                    to_scheduler_push_o,
    output logic [SLOT_BITS+32-1:0] to_scheduler_data_o,
    input  logic                    to_result_ready_i,
    output logic                    to_result_push_o,
    output logic [   SLOT_BITS-1:0] to_result_data_o,
    input  logic                    to_packets_ready_i,
    output logic                    to_packets_push_o,
    output logic [   SLOT_BITS+1:0] to_packets_data_o,     // {slot, joins, closes}

    output logic                 setup_write_o,
    output logic [SLOT_BITS-1:0] setup_slot_o,
    output logic [         95:0] setup_rcp_down_o,
    output logic [         95:0] setup_rcp_up_o,
    output logic [         31:0] setup_sx_o,
    output logic [         31:0] setup_sy_o,
    input  logic [         31:0] setup_root_i,  // of the ray in setup_slot_o

    output logic [3:0] activity_o
);
  localparam logic [31:0] ONE = 32'h3f800000;
  localparam int DIVISIONS = 5;
  localparam int TURNS_AT_MOST = MIN_INTERVAL < DIVISIONS ? MIN_INTERVAL : DIVISIONS;
  localparam int DIVIDERS = (DIVISIONS + TURNS_AT_MOST - 1) / TURNS_AT_MOST;
  localparam int TURNS = (DIVISIONS + DIVIDERS - 1) / DIVIDERS;
  localparam int SELECT_LATENCY = LATENCY > 1 ? 1 : 0;

  // Free contexts: those never used yet, then the freed ones in their order.
  logic [SLOT_BITS:0] unused_from_q, head_q, tail_q;
  logic [SLOT_BITS-1:0] freed_q[1 << SLOT_BITS];
  wire fresh = unused_from_q != contexts_i;
`ifdef CTU_MUTATE_RAY_FREED_FIRST
  assign ray_slot_o = head_q != tail_q ? freed_q[head_q[SLOT_BITS-1:0]] : unused_from_q[SLOT_BITS-1:0];
  wire takes_fresh = ray_take_o && head_q == tail_q;
`else
  assign ray_slot_o = fresh ? unused_from_q[SLOT_BITS-1:0] : freed_q[head_q[SLOT_BITS-1:0]];
  wire takes_fresh = ray_take_o && fresh;
`endif
  assign freed_pop_o = freed_valid_i;
  always_ff @(posedge clk_i) if (freed_valid_i) freed_q[tail_q[SLOT_BITS-1:0]] <= freed_data_i;
  always_ff @(posedge clk_i) begin
    if (rst_i) begin
      unused_from_q <= '0;
      head_q <= '0;
      tail_q <= '0;
    end else begin
      unused_from_q <= unused_from_q + (SLOT_BITS + 1)'(takes_fresh);
      head_q <= head_q + (SLOT_BITS + 1)'(ray_take_o && !takes_fresh);
      tail_q <= tail_q + (SLOT_BITS + 1)'(freed_valid_i);
    end
  end

  // The pipeline.
  logic can_enter, start, enable, exit_valid, leaves, empty;
  logic [SLOT_BITS-1:0] slot, slot_q, leaving_slot;
  logic accepted, valid, valid_q, leaving_valid, leaving_ready;
  pipe_control #(
      .LATENCY(LATENCY),
      .OCCUPIES_BITS(7)
  ) control (
      .clk_i,
      .rst_i,
      .enter_i(ray_take_o),
      .occupies_i(interval_i),
      .ready_i(leaving_ready),
      .can_enter_o(can_enter),
      .start_o(start),
      .enable_o(enable),
      .exit_valid_o(exit_valid),
      .exit_o(leaves),
      .empty_o(empty)
  );
  wire unused_control = &{1'b0, start, exit_valid};
  pipe_row #(
      .WIDTH(SLOT_BITS + 1),
      .DEPTH(LATENCY)
  ) row_token (
      .clk_i,
      .enable_i(enable),
      .data_i({slot, valid}),
      .data_o({leaving_slot, leaving_valid})
  );
  wire waits = ray_valid_i && can_enter;
  assign ray_take_o = waits && (fresh || head_q != tail_q);
  assign to_scheduler_push_o = !PACKETS && leaves && leaving_valid;
  assign to_scheduler_data_o = {leaving_slot, setup_root_i};
  assign to_result_push_o = leaves && !leaving_valid;
  assign to_result_data_o = leaving_slot;

  // Packets: what leaves may have two ways to go, then it needs both at once.
  generate
    if (PACKETS) begin : g_packets
      logic closes_q, leaving_closes;
      wire closes = ray_take_o ? ray_closes_i : closes_q;
      always_ff @(posedge clk_i) if (enable) closes_q <= closes;
      pipe_row #(
          .WIDTH(1),
          .DEPTH(LATENCY)
      ) row_closes (
          .clk_i,
          .enable_i(enable),
          .data_i(closes),
          .data_o(leaving_closes)
      );
      wire to_packets = leaving_valid || leaving_closes;
      assign leaving_ready = (!to_packets || to_packets_ready_i) && (leaving_valid || to_result_ready_i);
      assign to_packets_push_o = leaves && to_packets;
      assign to_packets_data_o = {leaving_slot, leaving_valid, leaving_closes};
      wire unused_scheduler = to_scheduler_ready_i;
    end else begin : g_alone
      assign leaving_ready = leaving_valid ? to_scheduler_ready_i : to_result_ready_i;
      assign to_packets_push_o = 1'b0;
      assign to_packets_data_o = '0;
      wire unused_packets = &{1'b0, ray_closes_i, to_packets_ready_i};
    end
  endgenerate
  assign activity_o = !enable ? `CTU_OUTPUT_FULL :
                      leaves || ray_take_o || !empty ? `CTU_BUSY :
                      waits ? `CTU_NO_CONTEXT : `CTU_IDLE;

  generate
    if (TREES > 1) begin : g_roots
      logic [31:0] roots_q[TREES];
`ifdef CTU_MUTATE_RAY_FIRST_TREE
      assign ray_root_o = roots_q[0];
      wire unused_tree = &{1'b0, ray_tree_i};
`else
      assign ray_root_o = roots_q[ray_tree_i];
`endif
      always_ff @(posedge clk_i) if (root_write_i) roots_q[root_tree_i] <= root_i;
    end else begin : g_root
      assign ray_root_o = 32'd0;
      wire unused_roots = &{1'b0, root_write_i, root_tree_i, root_i, ray_tree_i};
    end
  endgenerate

  // The ray at the entrance: the host's while it is taken, then the one kept here.
  logic [95:0] direction, direction_q;
  logic [6:0] rest, rest_q;  // cycles that it still keeps the entrance, this one included
  assign direction = ray_take_o ? ray_direction_i : direction_q;
  assign slot = ray_take_o ? ray_slot_o : slot_q;
  assign valid = ray_take_o ? accepted : valid_q;
  assign rest = ray_take_o ? interval_i : rest_q;
  always_ff @(posedge clk_i) begin
    if (enable) begin
      direction_q <= direction;
      slot_q <= slot;
      valid_q <= valid;
      rest_q <= rest == 7'd0 ? 7'd0 : rest - 7'd1;
    end
  end

  // Whether the unit accepts it.
  logic below, equal, unused_unordered;
  float_compare compare_range (
      .a_i(ray_tmin_i),
      .b_i(ray_tmax_i),
      .less_o(below),
      .equal_o(equal),
      .unordered_o(unused_unordered)
  );
  wire [7*8-1:0] exponents = {
    ray_tmin_i[30:23],
    ray_direction_i[94:87],
    ray_direction_i[62:55],
    ray_direction_i[30:23],
    ray_origin_i[94:87],
    ray_origin_i[62:55],
    ray_origin_i[30:23]
  };
  wire unused_fractions = &{1'b0, ray_origin_i};
  always_comb begin
`ifdef CTU_MUTATE_RAY_EMPTY_RANGE
    accepted = below;
`else
    accepted = below || equal;
`endif
    for (int i = 0; i < 7; i++) if (exponents[8*i+:8] == 8'hff) accepted = 1'b0;
    if (ray_zero_axes_o == 3'd7) accepted = 1'b0;
  end

  // Axes: kz along the largest component, of equal ones the last; kx and ky follow it, exchanged when it is negative.
  wire [30:0] x = direction[30:0];
  wire [30:0] y = direction[62:32];
  wire [30:0] z = direction[94:64];
  wire [2:0] signs = {direction[95], direction[63], direction[31]};
  wire [2:0] zeros = {z == 31'd0, y == 31'd0, x == 31'd0};
  logic [1:0] kx, ky, kz, after_kz, before_kz;
  always_comb begin
`ifdef CTU_MUTATE_RAY_TIED_AXES
    kz = z > x && z > y ? 2'd2 : y > x ? 2'd1 : 2'd0;
`else
    kz = z >= x && z >= y ? 2'd2 : y >= x ? 2'd1 : 2'd0;
`endif
    after_kz = kz == 2'd2 ? 2'd0 : kz + 2'd1;
    before_kz = kz == 2'd0 ? 2'd2 : kz - 2'd1;
`ifdef CTU_MUTATE_RAY_UNSWAPPED_AXES
    kx = after_kz;
    ky = before_kz;
`else
    kx = signs[kz] ? before_kz : after_kz;
    ky = signs[kz] ? after_kz : before_kz;
`endif
  end
  assign ray_zero_axes_o = zeros;
  assign ray_negative_axes_o = signs & ~zeros;
  assign ray_kx_o = kx;
  assign ray_ky_o = ky;
  assign ray_kz_o = kz;

  // Dividend and divisor of each division. A zero component is left out as 0 / 1.
  logic [64*TURNS*DIVIDERS-1:0] operands;
  always_comb begin
    operands = '0;
    for (int axis = 0; axis < 3; axis++)
      operands[64*axis+:64] = zeros[axis] ? {32'd0, ONE} : {ONE, direction[32*axis+:32]};
    operands[64*3+:64] = {direction[32*32'(kx)+:32], direction[32*32'(kz)+:32]};
    operands[64*4+:64] = {direction[32*32'(ky)+:32], direction[32*32'(kz)+:32]};
  end
  wire [2:0] turn = rest == 7'd0 || rest >= 7'(TURNS) ? 3'd0 : 3'(TURNS) - rest[2:0];

  // nearest, down, up of each division, as the ray leaves
  logic [96*TURNS*DIVIDERS-1:0] quotients;
  generate
    for (genvar divider = 0; divider < DIVIDERS; divider++) begin : g_divider
      wire [31:0] place = 32'(turn) * DIVIDERS + divider;
      logic [63:0] selected;
      pipe_row #(
          .WIDTH(64),
          .DEPTH(SELECT_LATENCY)
      ) row_selected (
          .clk_i,
          .enable_i(enable),
          .data_i(operands[64*place+:64]),
          .data_o(selected)
      );
      logic [31:0] nearest, down, up;
      float_div #(
          .LATENCY(LATENCY - SELECT_LATENCY)
      ) divide (
          .clk_i,
          .enable_i(enable),
          .a_i(selected[63:32]),
          .b_i(selected[31:0]),
          .nearest_o(nearest),
          .down_o(down),
          .up_o(up)
      );
      for (genvar earlier = 0; earlier < TURNS; earlier++) begin : g_turn
        pipe_row #(
            .WIDTH(96),
            .DEPTH(TURNS - 1 - earlier)
        ) row_quotient (
            .clk_i,
            .enable_i(enable),
            .data_i({nearest, down, up}),
            .data_o(quotients[96*(earlier*DIVIDERS+divider)+:96])
        );
      end
    end
  endgenerate

  assign setup_write_o = leaves && leaving_valid;
  assign setup_slot_o = leaving_slot;
  assign setup_rcp_down_o = {quotients[96*2+32+:32], quotients[96*1+32+:32], quotients[32+:32]};
  assign setup_rcp_up_o = {quotients[96*2+:32], quotients[96*1+:32], quotients[0+:32]};
  assign setup_sx_o = quotients[96*3+64+:32];
  assign setup_sy_o = quotients[96*4+64+:32];
  wire unused_quotients = &{1'b0, quotients};
endmodule
