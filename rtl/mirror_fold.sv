// mirror_fold: the row of a key where a key, its reverse and all their mirrored forms share one.
//
//   combinational
//   twin    MirrorFold::fold (model/cull/key_fold.h)
//
// (1) A pair (begin, end) of an axis that does not ascend is mirrored: c becomes R_RAY - 1 - c. (2) The last axis whose
// pair is not its own mirrored reverse decides: where its begin and end, mirrored so, add up to more than R_RAY - 1,
// begin and end of all axes change places before (1). (3) Row = the sum of a number from each axis, last axis first,
// each from a table of constants by the pair and by what the axes before have shown: whether one of them has decided,
// and whether all had inner cells only.
`include "key_fold.svh"

module mirror_fold #(
    parameter int AXES = 3,
    parameter int R_RAY = 4,
    parameter bit LEAVE_OUT_INNER = 1'b0,  // no rows for keys whose begin and end are both inner cells
    parameter int ROW_BITS = 12
) (
    input  logic [5*AXES-1:0] begin_i,      // the first axis lowest
    input  logic [5*AXES-1:0] end_i,
    output logic [ROW_BITS-1:0] row_o,
    output logic [    AXES-1:0] mirrored_o,   // axes on which the row's mask is to be mirrored
    output logic                left_out_o
);
  localparam int LAST = R_RAY - 1;
  localparam int PAIRS = R_RAY * R_RAY;

  // Rows of keys of which `axes` axes are still to come.
  function automatic int rows_from(input int axes, input bit decided, input bit inner);
    rows_from = `CTU_MIRRORED_CLASSES(axes, R_RAY, !decided) -
        (LEAVE_OUT_INNER && inner ? `CTU_MIRRORED_CLASSES(axes, R_RAY - 2, !decided) : 0);
  endfunction

  function automatic bit is_inner(input int cell_number);
    is_inner = cell_number > 0 && cell_number < LAST;
  endfunction

  // By ascending pair, begin + R_RAY * end: rows of the pairs before it.
  function automatic logic [ROW_BITS*PAIRS-1:0] rows_before(input int axis, input bit decided, input bit inner);
    int rows;
    rows = 0;
    rows_before = (ROW_BITS*PAIRS)'(0);
    for (int e = 0; e < R_RAY; e++) begin
      for (int b = 0; b <= e; b++) begin
        if (b < e || 2 * b <= LAST) begin
          rows_before[ROW_BITS*(b+R_RAY*e)+:ROW_BITS] = ROW_BITS'(rows);
          if (b == e || b + e == LAST) rows = rows + rows_from(axis, decided, inner && is_inner(b) && is_inner(e));
          else if (b + e < LAST || decided) rows = rows + rows_from(axis, 1'b1, inner && is_inner(b) && is_inner(e));
        end
      end
    end
  endfunction

  function automatic bit ascends(input logic [4:0] b, input logic [4:0] e);
    ascends = b < e || (b == e && {b, 1'b0} <= 6'(LAST));
  endfunction

  // (2): whether begin and end change places.
  logic exchange;
  always_comb begin
    exchange = 1'b0;
    for (int axis = 0; axis < AXES; axis++) begin
      if (begin_i[5*axis+:5] != end_i[5*axis+:5] && {1'b0, begin_i[5*axis+:5]} + {1'b0, end_i[5*axis+:5]} != 6'(LAST))
        exchange = ({1'b0, begin_i[5*axis+:5]} + {1'b0, end_i[5*axis+:5]} > 6'(LAST)) ==
            ascends(begin_i[5*axis+:5], end_i[5*axis+:5]);
    end
  end

  // (1) and (3).
  logic [ROW_BITS*AXES-1:0] row_of;
  logic [AXES:0] decides, is_outer;  // whether an axis decides, and whether it has a cell at the surface
  assign decides[AXES] = 1'b0;
  assign is_outer[AXES] = 1'b0;
  generate
    for (genvar axis = 0; axis < AXES; axis++) begin : g_axis
      localparam logic [ROW_BITS*PAIRS-1:0] UNDECIDED = rows_before(axis, 1'b0, 1'b0);
      localparam logic [ROW_BITS*PAIRS-1:0] DECIDED = rows_before(axis, 1'b1, 1'b0);
      localparam logic [ROW_BITS*PAIRS-1:0] INNER_UNDECIDED = rows_before(axis, 1'b0, 1'b1);
      localparam logic [ROW_BITS*PAIRS-1:0] INNER_DECIDED = rows_before(axis, 1'b1, 1'b1);
      localparam int PAIR_BITS = $clog2(PAIRS);

      wire [4:0] from = exchange ? end_i[5*axis+:5] : begin_i[5*axis+:5];
      wire [4:0] to = exchange ? begin_i[5*axis+:5] : end_i[5*axis+:5];
      wire mirrored = !ascends(from, to);
      wire [4:0] b = mirrored ? 5'(LAST) - from : from;
      wire [4:0] e = mirrored ? 5'(LAST) - to : to;
      wire [PAIR_BITS-1:0] pair = PAIR_BITS'(b) + PAIR_BITS'(e * PAIR_BITS'(R_RAY));
      assign mirrored_o[axis] = mirrored;
      wire decided = |decides[AXES:axis+1];
      wire inner = ~|is_outer[AXES:axis+1];
      assign decides[axis] = b != e && {1'b0, b} + {1'b0, e} != 6'(LAST);
      assign is_outer[axis] = b == 5'd0 || e == 5'(LAST);
      always_comb begin
        case ({inner, decided})
          2'b00: row_of[ROW_BITS*axis+:ROW_BITS] = UNDECIDED[ROW_BITS*pair+:ROW_BITS];
          2'b01: row_of[ROW_BITS*axis+:ROW_BITS] = DECIDED[ROW_BITS*pair+:ROW_BITS];
          2'b10: row_of[ROW_BITS*axis+:ROW_BITS] = INNER_UNDECIDED[ROW_BITS*pair+:ROW_BITS];
          default: row_of[ROW_BITS*axis+:ROW_BITS] = INNER_DECIDED[ROW_BITS*pair+:ROW_BITS];
        endcase
      end
    end
  endgenerate
  always_comb begin
    row_o = '0;
    for (int axis = 0; axis < AXES; axis++) row_o = row_o + row_of[ROW_BITS*axis+:ROW_BITS];
  end
  assign left_out_o = LEAVE_OUT_INNER && is_outer == '0;
  wire unused_state = &{1'b0, decides[0], is_outer[0]};
endmodule
