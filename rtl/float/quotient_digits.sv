// quotient_digits: the digits of a quotient of two significands by restoring division: the part that every divider
// shares.
//
//   latency the first DIGITS + 1 of STEPS steps of LATENCY (0: combinational), initiation interval 1; enable_i stops all
//           registers
//
// Arithmetic: a_i and b_i have their highest bit set. digits_o is a_i / b_i moved into [1, 2), cut behind the bit that
// follows its 24; inexact_o says whether anything is cut off, and exponent_o is exponent_i, less 1 where a_i < b_i. What
// rides along comes out with them.
module quotient_digits #(
    parameter int LATENCY = 16,
    parameter int STEPS = 28,          // of the divider: order, 25 digits, and its own
    parameter int EXPONENT_BITS = 10,
    parameter int SIDE_BITS = 4,       // ride along
    localparam int DIGITS = 25         // 24 of the significand and the guard bit
) (
    input  logic                     clk_i,
    input  logic                     enable_i,
    input  logic [             23:0] a_i,
    input  logic [             23:0] b_i,
    input  logic [EXPONENT_BITS-1:0] exponent_i,
    input  logic [    SIDE_BITS-1:0] side_i,
    output logic [       DIGITS-1:0] digits_o,
    output logic                     inexact_o,
    output logic [EXPONENT_BITS-1:0] exponent_o,
    output logic [    SIDE_BITS-1:0] side_o
);
  // The dividend doubled where it is the smaller one, so that the quotient lies in [1, 2).
  logic [24:0] dividend;
  logic [EXPONENT_BITS-1:0] exponent;
  logic doubled;
  always_comb begin
    doubled = a_i < b_i;
    dividend = doubled ? {a_i, 1'b0} : {1'b0, a_i};
    exponent = doubled ? exponent_i - EXPONENT_BITS'(1) : exponent_i;
  end

  // A digit a step. What remains is always below twice the divisor.
  localparam int NUMBER_BITS = 24 + EXPONENT_BITS + SIDE_BITS;
  generate
    for (genvar step = 0; step <= DIGITS; step++) begin : g_step
      localparam int REGISTERS = (step + 1) * LATENCY / STEPS - step * LATENCY / STEPS;
      logic [24:0] remainder, remainder_q;
      logic [NUMBER_BITS-1:0] number, number_q;  // divisor highest
      localparam int FOUND = step == 0 ? 1 : step;  // digits so far; a zero stands for none
      logic [FOUND-1:0] quotient, quotient_q;
      if (step == 0) begin : g_first
        assign remainder = dividend;
        assign quotient = 1'b0;
        assign number = {b_i, exponent, side_i};
        wire unused_quotient = quotient_q;
      end else begin : g_digit
        wire [24:0] current = g_step[step-1].remainder_q;
        wire [23:0] divisor = g_step[step-1].number_q[NUMBER_BITS-1-:24];
        wire [23:0] reduced = current[23:0] - divisor;
        wire fits = current >= {1'b0, divisor};
        assign number = g_step[step-1].number_q;
        // The last remainder only says whether the quotient is exact, so doubling it as well does no harm.
        assign remainder = {fits ? reduced : current[23:0], 1'b0};
        if (step == 1) begin : g_one
          assign quotient = fits;
        end else begin : g_more
          assign quotient = {g_step[step-1].quotient_q, fits};
        end
      end
      pipe_row #(
          .WIDTH(NUMBER_BITS),
          .DEPTH(REGISTERS)
      ) row_number (
          .clk_i,
          .enable_i,
          .data_i(number),
          .data_o(number_q)
      );
      pipe_row #(
          .WIDTH(25 + FOUND),
          .DEPTH(REGISTERS)
      ) row_digits (
          .clk_i,
          .enable_i,
          .data_i({remainder, quotient}),
          .data_o({remainder_q, quotient_q})
      );
    end
  endgenerate
  logic [23:0] unused_divisor;
  assign digits_o = g_step[DIGITS].quotient_q;
  assign inexact_o = g_step[DIGITS].remainder_q != 25'd0;
  assign {unused_divisor, exponent_o, side_o} = g_step[DIGITS].number_q;
endmodule
