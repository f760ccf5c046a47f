// mask_mirror: a mask with cell c at R - 1 - c on some axes.
//
//   combinational
//   twin    cull::mirrored_mask (model/cull/mask_mirror.h)
module mask_mirror #(
    parameter int R = 4,
    parameter int AXES = 3,  // 2: rows of projections
    localparam int CELLS = R * R * (AXES > 2 ? R : 1)
) (
    input  logic [CELLS-1:0] mask_i,
    input  logic [ AXES-1:0] axes_i,
    output logic [CELLS-1:0] mask_o
);
  logic [CELLS-1:0] as_it_was;
  always_comb begin
    mask_o = mask_i;
    for (int axis = 0; axis < AXES; axis++) begin
      as_it_was = mask_o;
      for (int place = 0; place < CELLS; place++) begin
        // With the stride of the axis: 1, R, R * R.
        if (axes_i[axis])
          mask_o[place] =
              axis == 0 ? as_it_was[place+R-1-2*(place%R)] :
              axis == 1 ? as_it_was[place+R*(R-1-2*(place/R%R))] : as_it_was[place+R*R*(R-1-2*(place/(R*R)%R))];
      end
    end
  end
endmodule
