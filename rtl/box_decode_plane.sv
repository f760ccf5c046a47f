// box_decode_plane: one plane of a box of reduced precision as binary32: origin + q * 2^(exponent - 149), rounded down,
// or with UPPER up.
//
//   latency LATENCY (docs/unit.md: 1 convert, 4 add: 5), any from 0; initiation interval 1; enable_i stops all registers
//   twin    ctu::accel::decode_plane (model/accel/box_frame.h)
//
// Arithmetic: q steps are a binary32 number, exactly: q moved up until its highest one is the hidden bit, or by exponent,
// where the number is subnormal; infinite beyond the largest. Then one directed addition; a sum beyond binary32 is the
// largest finite number. Exponents go to 276, step 2^127.
`include "float_format.svh"

module box_decode_plane #(
    parameter int BITS = 16,   // of q: 16, 12 or 8
    parameter int LATENCY = 5,
    parameter bit UPPER = 1'b0
) (
    input  logic            clk_i,
    input  logic            enable_i,
    input  logic [    31:0] origin_i,
    input  logic [     8:0] exponent_i,
    input  logic [BITS-1:0] q_i,
    output logic [    31:0] plane_o
);
  localparam int CONVERT_LATENCY = LATENCY / 5;

  // 1: the steps as binary32.
  logic [3:0] zeros;
  logic [4:0] zeros_of_24, shift;
  logic [23:0] significand;
  logic [8:0] exponent;
  logic [31:0] offset;
  leading_zeros #(
      .WIDTH(16)
  ) count (
      .value_i(16'(q_i)),
      .count_o(zeros)
  );
  always_comb begin
    zeros_of_24 = {1'b0, zeros} + 5'd8;
`ifdef CTU_MUTATE_DECODE_NORMAL_ONLY
    shift = zeros_of_24;
`else
    shift = {4'd0, zeros_of_24} < exponent_i ? zeros_of_24 : exponent_i[4:0];
`endif
    significand = 24'(q_i) << shift;
    exponent = exponent_i + 9'd1 - {4'd0, shift};
    offset = {1'b0, exponent[7:0], significand[22:0]};
    if (!significand[23]) offset = {9'd0, significand[22:0]};  // subnormal, or zero
    else if (exponent >= 9'd255) offset = `FLOAT_PLUS_INFINITY;
  end

  logic [31:0] offset_q, origin_q;
  pipe_row #(
      .WIDTH(64),
      .DEPTH(CONVERT_LATENCY)
  ) row_convert (
      .clk_i,
      .enable_i,
      .data_i({offset, origin_i}),
      .data_o({offset_q, origin_q})
  );

  // 2: above the origin. Of finite origins only sums that are too large are infinite.
  logic [31:0] sum;
`ifdef CTU_MUTATE_DECODE_TO_NEAREST
  localparam logic [1:0] ROUND = `FLOAT_ROUND_NEAREST;
`else
  localparam logic [1:0] ROUND = UPPER ? `FLOAT_ROUND_UP : `FLOAT_ROUND_DOWN;
`endif
  float_add #(
      .LATENCY(LATENCY - CONVERT_LATENCY)
  ) add (
      .clk_i,
      .enable_i,
      .a_i(origin_q),
      .b_i(offset_q),
      .subtract_i(1'b0),
      .round_i(ROUND),
      .result_o(sum)
  );
`ifdef CTU_MUTATE_DECODE_UNLIMITED
  assign plane_o = sum;
`else
  assign plane_o = sum[31:23] == 9'h0ff ? 32'h7f7fffff : sum;
`endif
endmodule
