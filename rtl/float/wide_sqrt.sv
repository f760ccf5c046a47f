// wide_sqrt: the square root of a wide number (wide_format.svh), rounded once.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    round24(std::sqrt(a)) of model/intersect/sphere_test.cpp
//
// Arithmetic: a is not negative (if it is, the result says nothing). A digit a step, by restoring: of the radicand, in
// [1, 4), two bits come down, and the root so far, with 01 behind it, is taken away if it fits. Steps: 25 digits, round;
// the LATENCY registers are spread over the places behind each of them, the last place first.
`include "wide_format.svh"

module wide_sqrt #(
    parameter int LATENCY = 12
) (
    input  logic                  clk_i,
    input  logic                  enable_i,
    input  logic [`WIDE_BITS-1:0] a_i,
    output logic [`WIDE_BITS-1:0] result_o
);
  localparam int DIGITS = 25;  // 24 of the significand and the guard bit
  localparam int STEPS = DIGITS + 1;
  localparam int RADICAND = 26;  // bits of it that can be set: 13 pairs

  wire unused_sign = a_i[`WIDE_SIGN];

  // An even power of two before the radicand; the biased exponent is odd where the power is even.
  wire even = a_i[24];
  wire [RADICAND-1:0] radicand =
      even ? {1'b0, a_i[`WIDE_SIGNIFICAND], 1'b0} : {a_i[`WIDE_SIGNIFICAND], 2'd0};
  wire [10:0] exponent = {1'b0, a_i[34:25]} + 11'd511 + {10'd0, even};  // (e - 1023) / 2 + 1023

  generate
    for (genvar step = 1; step <= DIGITS; step++) begin : g_step
      localparam int REGISTERS = step * LATENCY / STEPS - (step - 1) * LATENCY / STEPS;
      localparam int REST = RADICAND - 2 * step > 0 ? RADICAND - 2 * step : 1;  // bits that have not come down
      logic [step:0] remainder, remainder_q;  // at most twice the root
      logic [step-1:0] root, root_q;
      logic [REST-1:0] rest, rest_q;
      logic [11:0] number_q;  // exponent, not zero
      logic [step+1:0] current, trial;
      logic fits;
      logic [11:0] number;
      if (step == 1) begin : g_first
        assign current = {1'b0, radicand[RADICAND-1-:2]};
        assign trial = 3'd1;
        assign root = fits;
        assign rest = radicand[REST-1:0];
        assign number = {exponent, a_i[`WIDE_NOT_ZERO]};
      end else begin : g_more
        if (2 * step <= RADICAND) begin : g_pair
          assign current = {g_step[step-1].remainder_q, g_step[step-1].rest_q[RADICAND-2*step+1-:2]};
          if (2 * step < RADICAND) begin : g_rest
            assign rest = g_step[step-1].rest_q[REST-1:0];
          end else begin : g_no_rest
            assign rest = 1'b0;
          end
        end else begin : g_zeros
          assign current = {g_step[step-1].remainder_q, 2'd0};
          assign rest = 1'b0;
          wire unused_rest = &{1'b0, g_step[step-1].rest_q};
        end
        assign trial = {1'b0, g_step[step-1].root_q, 2'd1};
        assign root = {g_step[step-1].root_q, fits};
        assign number = g_step[step-1].number_q;
      end
      assign fits = current >= trial;
      assign remainder = (step + 1)'(fits ? current - trial : current);
      pipe_row #(
          .WIDTH(2 * step + 1 + REST + 12),
          .DEPTH(REGISTERS)
      ) row (
          .clk_i,
          .enable_i,
          .data_i({remainder, root, rest, number}),
          .data_o({remainder_q, root_q, rest_q, number_q})
      );
    end
  endgenerate

  wire [DIGITS-1:0] digits = g_step[DIGITS].root_q;
  wire unused_rest = &{1'b0, g_step[DIGITS].rest_q};
  logic [`WIDE_BITS-1:0] rounded;
  wide_round round (
      .sign_i(1'b0),
      .exponent_i(g_step[DIGITS].number_q[11:1]),
      .significand_i(g_step[DIGITS].number_q[0] ? digits[24:1] : 24'd0),
      .guard_i(digits[0]),
`ifdef CTU_MUTATE_WIDE_ROOT_STICKY
      .sticky_i(1'b0),
`else
      .sticky_i(g_step[DIGITS].remainder_q != '0),
`endif
      .result_o(rounded)
  );
  pipe_row #(
      .WIDTH(`WIDE_BITS),
      .DEPTH(LATENCY - DIGITS * LATENCY / STEPS)
  ) row_result (
      .clk_i,
      .enable_i,
      .data_i(rounded),
      .data_o(result_o)
  );
endmodule
