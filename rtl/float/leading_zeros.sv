// leading_zeros: how many zeros stand above the highest one; combinational. WIDTH a power of two; of all zeros the
// count is WIDTH - 1, as the callers shift no further.
module leading_zeros #(
    parameter int WIDTH = 32,
    parameter int COUNT_BITS = $clog2(WIDTH)
) (
    input  logic [     WIDTH-1:0] value_i,
    output logic [COUNT_BITS-1:0] count_o
);
  logic [WIDTH-1:0] rest;

  // The upper half empty: count it and look at the lower half, then the same with quarters, and so on.
  always_comb begin
    rest = value_i;
    count_o = '0;
    for (int bit_index = COUNT_BITS - 1; bit_index >= 0; bit_index--) begin
      if ((rest >> (WIDTH - (1 << bit_index))) == '0) begin
        count_o[bit_index] = 1'b1;
        rest = rest << (1 << bit_index);
      end
    end
  end
endmodule
