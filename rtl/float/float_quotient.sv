// float_quotient: the quotient of two significands as binary32, exactly rounded in one direction or in all three at
// once: the part that every divider shares.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    the division in model/numeric/round.h
//
// Arithmetic: a_i and b_i have their highest bit set unless zero_i, infinite_i or nan_i says what the quotient is; it
// is a_i / b_i * 2^(exponent_i - 127), subnormal or overflowing as float_round says. Steps: order, 25 digits by
// restoring division, shift of subnormal quotients, round; the LATENCY registers are spread over the places behind each
// of them, the last place first.
module float_quotient #(
    parameter int LATENCY = 16,
    parameter bit DIRECTED = 1'b1  // 0: nearest_o alone, the others are zero
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [23:0] a_i,
    input  logic [23:0] b_i,
    input  logic [ 9:0] exponent_i,  // two's complement, -512 < exponent_i < 511
    input  logic        sign_i,
    input  logic        zero_i,
    input  logic        infinite_i,
    input  logic        nan_i,
    output logic [31:0] nearest_o,
    output logic [31:0] down_o,
    output logic [31:0] up_o
);
  localparam int DIGITS = 25;  // 24 of the significand and the guard bit
  localparam int STEPS = DIGITS + 3;

  // 1: the dividend doubled where it is the smaller one, so that the quotient lies in [1, 2).
  logic [24:0] dividend;
  logic [9:0] exponent;
  logic doubled;
  always_comb begin
    doubled = a_i < b_i;
    dividend = doubled ? {a_i, 1'b0} : {1'b0, a_i};
    exponent = doubled ? exponent_i - 10'd1 : exponent_i;
  end

  // 2: a digit a step. What remains is always below twice the divisor.
  generate
    for (genvar step = 0; step <= DIGITS; step++) begin : g_step
      logic [24:0] remainder, remainder_q;
      logic [23:0] divisor_q;
      localparam int FOUND = step == 0 ? 1 : step;  // digits so far; a zero stands for none
      logic [FOUND-1:0] quotient, quotient_q;
      logic [9:0] exponent_q;
      logic sign_q, zero_q, infinite_q, nan_q;
      if (step == 0) begin : g_first
        assign remainder = dividend;
        assign quotient = 1'b0;
        wire unused_quotient = quotient_q;
        pipe_row #(
            .WIDTH(38),
            .DEPTH(LATENCY / STEPS)
        ) row_number (
            .clk_i,
            .enable_i,
            .data_i({b_i, exponent, sign_i, zero_i, infinite_i, nan_i}),
            .data_o({divisor_q, exponent_q, sign_q, zero_q, infinite_q, nan_q})
        );
      end else begin : g_digit
        wire [24:0] current = g_step[step-1].remainder_q;
        wire [23:0] reduced = current[23:0] - g_step[step-1].divisor_q;
        wire fits = current >= {1'b0, g_step[step-1].divisor_q};
        // The last remainder only says whether the quotient is exact, so doubling it as well does no harm.
        assign remainder = {fits ? reduced : current[23:0], 1'b0};
        if (step == 1) begin : g_one
          assign quotient = fits;
        end else begin : g_more
          assign quotient = {g_step[step-1].quotient_q, fits};
        end
        pipe_row #(
            .WIDTH(38),
            .DEPTH((step + 1) * LATENCY / STEPS - step * LATENCY / STEPS)
        ) row_number (
            .clk_i,
            .enable_i,
            .data_i({g_step[step-1].divisor_q, g_step[step-1].exponent_q, g_step[step-1].sign_q,
                     g_step[step-1].zero_q, g_step[step-1].infinite_q, g_step[step-1].nan_q}),
            .data_o({divisor_q, exponent_q, sign_q, zero_q, infinite_q, nan_q})
        );
      end
      pipe_row #(
          .WIDTH(25 + FOUND),
          .DEPTH((step + 1) * LATENCY / STEPS - step * LATENCY / STEPS)
      ) row_digits (
          .clk_i,
          .enable_i,
          .data_i({remainder, quotient}),
          .data_o({remainder_q, quotient_q})
      );
    end
  endgenerate

  // 3: a quotient below the smallest normal number moves down, to exponent 1.
  wire [9:0] exponent_d = g_step[DIGITS].exponent_q;
  wire [DIGITS-1:0] digits = g_step[DIGITS].quotient_q;
  wire inexact = g_step[DIGITS].remainder_q != 25'd0;
  wire unused_divisor = &{1'b0, g_step[DIGITS].divisor_q};
  logic subnormal, sticky;
  logic [9:0] below;
  logic [4:0] shift;
  logic [DIGITS-1:0] placed;
  always_comb begin
    subnormal = exponent_d[9] || exponent_d == 10'd0;
    below = 10'd1 - exponent_d;
    shift = !subnormal ? 5'd0 : below > 10'd31 ? 5'd31 : below[4:0];
    placed = digits >> shift;
    sticky = inexact || (digits & ~({DIGITS{1'b1}} << shift)) != '0;
`ifdef CTU_MUTATE_QUOTIENT_STICKY
    sticky = (digits & ~({DIGITS{1'b1}} << shift)) != '0;
`endif
    if (g_step[DIGITS].zero_q) begin
      placed = '0;
      sticky = 1'b0;
    end
  end

  logic [23:0] significand_q;
  logic [8:0] exponent_q;
  logic guard_q, sticky_q, sign_q, infinite_q, nan_q;
  pipe_row #(
      .WIDTH(38),
      .DEPTH((STEPS - 1) * LATENCY / STEPS - (STEPS - 2) * LATENCY / STEPS)
  ) row_placed (
      .clk_i,
      .enable_i,
      .data_i({placed, sticky, subnormal ? 9'd1 : exponent_d[8:0], g_step[DIGITS].sign_q, g_step[DIGITS].infinite_q,
               g_step[DIGITS].nan_q}),
      .data_o({significand_q, guard_q, sticky_q, exponent_q, sign_q, infinite_q, nan_q})
  );

  // 4: rounded and packed, in the order of round_i's values.
  generate
    for (genvar direction = 0; direction < (DIRECTED ? 3 : 1); direction++) begin : g_round
      localparam logic [1:0] ROUND = direction[1:0];
      logic [31:0] rounded;
      float_finish #(
          .LATENCY(LATENCY - (STEPS - 1) * LATENCY / STEPS)
      ) finish (
          .clk_i,
          .enable_i,
          .sign_i(sign_q),
          .exponent_i(exponent_q),
          .significand_i(significand_q),
          .guard_i(guard_q),
          .sticky_i(sticky_q),
          .infinite_i(infinite_q),
          .nan_i(nan_q),
          .round_i(ROUND),
          .result_o(rounded)
      );
    end
  endgenerate
  assign nearest_o = g_round[0].rounded;
  generate
    if (DIRECTED) begin : g_directed
      assign down_o = g_round[1].rounded;
      assign up_o = g_round[2].rounded;
    end else begin : g_nearest
      assign down_o = 32'd0;
      assign up_o = 32'd0;
    end
  endgenerate
endmodule
