// align_add: the sum or difference of two magnitudes of which the smaller one must first move down; combinational.
// It moves into place with two bits more, what falls off kept as one sticky bit below these. Bits fall off only where
// the larger magnitude has its highest bit set; the sum has its highest one in its first three places then, so two bits
// and the sticky one suffice to round it to WIDTH bits or fewer.
module align_add #(
    parameter int WIDTH = 24,
    parameter int DISTANCE_BITS = 8
) (
    input  logic [        WIDTH-1:0] larger_i,
    input  logic [        WIDTH-1:0] smaller_i,   // the smaller one, once it has moved
    input  logic [DISTANCE_BITS-1:0] distance_i,
    input  logic                     opposite_i,  // the difference
    output logic [        WIDTH+3:0] sum_o        // carry, WIDTH places, two bits more, sticky
);
  localparam int PLACES = WIDTH + 2;
  localparam int SHIFT_BITS = $clog2(PLACES + 1);

  logic [PLACES-1:0] wide_smaller, aligned;
  logic beyond, sticky;
  always_comb begin
    wide_smaller = {smaller_i, 2'b00};
    beyond = distance_i[DISTANCE_BITS-1:SHIFT_BITS] != '0;
    aligned = beyond ? '0 : wide_smaller >> distance_i[SHIFT_BITS-1:0];
    sticky = beyond ? smaller_i != '0 : (wide_smaller & ~({PLACES{1'b1}} << distance_i[SHIFT_BITS-1:0])) != '0;
`ifdef CTU_MUTATE_ALIGNMENT_STICKY
    sticky = 1'b0;
`elsif CTU_MUTATE_WIDE_ALIGNMENT_STICKY
    sticky = 1'b0;
`endif
    sum_o = opposite_i ? {1'b0, larger_i, 3'b000} - {1'b0, aligned, sticky}
                       : {1'b0, larger_i, 3'b000} + {1'b0, aligned, sticky};
  end
endmodule
