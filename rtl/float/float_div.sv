// float_div: a / b of binary32, exactly rounded in all three directions at once: the digits are the expensive part, and a
// ray needs its reciprocals rounded both down and up.
//
//   latency LATENCY (0: combinational), initiation interval 1; enable_i stops all registers
//   twin    ctu::numeric::div (model/numeric/round.h)
//
// Arithmetic: subnormals as any number; 0 / 0, infinity / infinity and NaN operands give 0x7fc00000; a number / 0 is
// infinite; signs as IEEE 754; overflow as float_round says. Steps: normalise, 25 digits by restoring division, shift of
// subnormal quotients, round; the LATENCY registers are spread over the places behind each of them, the last place first.
module float_div #(
    parameter int LATENCY = 16
) (
    input  logic        clk_i,
    input  logic        enable_i,
    input  logic [31:0] a_i,
    input  logic [31:0] b_i,
    output logic [31:0] nearest_o,
    output logic [31:0] down_o,
    output logic [31:0] up_o
);
  localparam int DIGITS = 25;  // 24 of the significand and the guard bit
  localparam int STEPS = DIGITS + 3;

  // 1: both significands with their highest one on top, the dividend doubled where it is the smaller one, so that the
  // quotient lies in [1, 2). The exponent is biased, and may lie outside of what a number can have.
  logic [4:0] a_zeros, b_zeros;
  leading_zeros #(
      .WIDTH(32)
  ) count_a (
      .value_i({a_i[30:23] != 8'd0, a_i[22:0], 8'd0}),
      .count_o(a_zeros)
  );
  leading_zeros #(
      .WIDTH(32)
  ) count_b (
      .value_i({b_i[30:23] != 8'd0, b_i[22:0], 8'd0}),
      .count_o(b_zeros)
  );

  logic [23:0] a_normal, divisor;
  logic [24:0] dividend;
  logic [9:0] exponent;  // two's complement, -150 .. 403
  logic doubled, sign, zero, infinite, nan;
  logic a_zero, b_zero, a_infinite, b_infinite;
  always_comb begin
    a_normal = {a_i[30:23] != 8'd0, a_i[22:0]} << a_zeros;
    divisor = {b_i[30:23] != 8'd0, b_i[22:0]} << b_zeros;
    doubled = a_normal < divisor;
    dividend = doubled ? {a_normal, 1'b0} : {1'b0, a_normal};
    // A subnormal has the exponent of the smallest normal numbers, and no hidden one.
    exponent = {2'd0, a_i[30:24], a_i[23] | (a_i[30:23] == 8'd0)} - {5'd0, a_zeros} -
               {2'd0, b_i[30:24], b_i[23] | (b_i[30:23] == 8'd0)} + {5'd0, b_zeros} + (doubled ? 10'd126 : 10'd127);
    sign = a_i[31] ^ b_i[31];
    a_zero = a_i[30:0] == 31'd0;
    b_zero = b_i[30:0] == 31'd0;
    a_infinite = a_i[30:0] == 31'h7f800000;
    b_infinite = b_i[30:0] == 31'h7f800000;
    zero = a_zero || b_infinite;
    infinite = a_infinite || b_zero;
    nan = a_i[30:0] > 31'h7f800000 || b_i[30:0] > 31'h7f800000 || (zero && infinite);
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
            .data_i({divisor, exponent, sign, zero, infinite, nan}),
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
    for (genvar direction = 0; direction < 3; direction++) begin : g_round
      localparam logic [1:0] ROUND = direction[1:0];
      logic [31:0] rounded, rounded_q;
      float_round round (
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
      pipe_row #(
          .WIDTH(32),
          .DEPTH(LATENCY - (STEPS - 1) * LATENCY / STEPS)
      ) row_rounded (
          .clk_i,
          .enable_i,
          .data_i(rounded),
          .data_o(rounded_q)
      );
    end
  endgenerate
  assign nearest_o = g_round[0].rounded_q;
  assign down_o = g_round[1].rounded_q;
  assign up_o = g_round[2].rounded_q;
endmodule
