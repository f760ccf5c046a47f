// next_in_turn: the first member of a set at or after a place, going round; combinational.
//
//   twin    model/pipeline/slot_set.h, next_from
module next_in_turn #(
    parameter int PLACE_BITS = 5
) (
    input  logic [(1<<PLACE_BITS)-1:0] members_i,
    input  logic [     PLACE_BITS-1:0] start_i,
    output logic                       found_o,    // the set is not empty
    output logic [     PLACE_BITS-1:0] place_o     // means nothing where not found
);
  localparam int PLACES = 1 << PLACE_BITS;

  // Members before the start count only where there is none behind it. The lowest of what is left is the one: the lower
  // half empty, it lies in the upper one, and the same with quarters, and so on.
  logic [PLACES-1:0] behind, left;
  always_comb begin
`ifdef CTU_MUTATE_TURN_BEHIND_START
    behind = members_i & ({PLACES{1'b1}} << start_i << 1);
`else
    behind = members_i & ({PLACES{1'b1}} << start_i);
`endif
    left = behind != '0 ? behind : members_i;
    found_o = members_i != '0;
    place_o = '0;
    for (int place_bit = PLACE_BITS - 1; place_bit >= 0; place_bit--) begin
      if ((left << (PLACES - (1 << place_bit))) == '0) begin
        place_o[place_bit] = 1'b1;
        left = left >> (1 << place_bit);
      end
    end
  end
endmodule
