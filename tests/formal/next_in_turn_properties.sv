// What next_in_turn promises (rtl/next_in_turn.sv): no other member comes before the one it names.
module next_in_turn_properties #(
    parameter int PLACE_BITS = 5
) (
    input logic [(1<<PLACE_BITS)-1:0] members_i,
    input logic [     PLACE_BITS-1:0] start_i,
    input logic [     PLACE_BITS-1:0] other_i     // any place
);
  logic found;
  logic [PLACE_BITS-1:0] place;
  next_in_turn #(.PLACE_BITS(PLACE_BITS)) dut (.members_i, .start_i, .found_o(found), .place_o(place));

  // How far on from the start, going round.
  wire [PLACE_BITS-1:0] distance = place - start_i;
  wire [PLACE_BITS-1:0] other_distance = other_i - start_i;
  always_comb begin
    finds : assert (found == (members_i != '0));
    member : assert (!found || members_i[place]);
    first : assert (!members_i[other_i] || distance <= other_distance);
    at_start : cover (found && distance == '0);
    round : cover (found && place < start_i && other_distance > distance && members_i[other_i]);
  end
endmodule
