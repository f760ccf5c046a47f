// The mask test's designs and which rows their tables have, as the parameters of modules name them: the numbers of
// cull::Design (model/cull/options.h) and cull::TableRows (model/cull/on_chip_tables.h).
`ifndef CTU_MASK_DESIGNS_SVH
`define CTU_MASK_DESIGNS_SVH

`define CTU_DESIGN_NONE 0
`define CTU_DESIGN_MASK_LUT 2
`define CTU_DESIGN_BIT_TABLE 3
`define CTU_DESIGN_DEDUP 4
`define CTU_DESIGN_PROJECTION 5
`define CTU_DESIGN_COMPARATORS 6

`define CTU_ROWS_ALL 0
`define CTU_ROWS_FOLDED 1
`define CTU_ROWS_REACHABLE 2

`endif
