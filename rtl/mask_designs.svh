// The mask test's designs and which rows their tables have, as the parameters of modules name them: the numbers of
// cull::Design (model/cull/options.h) and cull::TableRows (model/cull/on_chip_tables.h).
`ifndef CTU_MASK_DESIGNS_SVH
`define CTU_MASK_DESIGNS_SVH

`include "key_fold.svh"

`define CTU_DESIGN_NONE 0
`define CTU_DESIGN_MASK_LUT 2
`define CTU_DESIGN_BIT_TABLE 3
`define CTU_DESIGN_DEDUP 4
`define CTU_DESIGN_PROJECTION 5
`define CTU_DESIGN_COMPARATORS 6

`define CTU_ROWS_ALL 0
`define CTU_ROWS_FOLDED 1
`define CTU_ROWS_REACHABLE 2

// What the tables look like that follows from these. ENTRIES of the compression LUT, 0: object masks are not compressed.
// Rows that hold the answer for each entry instead of a mask.
`define CTU_BIT_ROWS(DESIGN, ENTRIES) \
  ((DESIGN) == `CTU_DESIGN_BIT_TABLE || ((DESIGN) == `CTU_DESIGN_DEDUP && (ENTRIES) > 0))
// The compression LUT is read, by each lane's index.
`define CTU_READS_LUT(DESIGN, ENTRIES) ((ENTRIES) > 0 && !`CTU_BIT_ROWS(DESIGN, ENTRIES))
// Folded rows are masks that can be mirrored; the id of a folded key in dedup's table has 3 bits that say how.
`define CTU_ROWS_MIRROR(DESIGN, ENTRIES, ROWS) \
  ((DESIGN) != `CTU_DESIGN_COMPARATORS && (ROWS) != `CTU_ROWS_ALL && !`CTU_BIT_ROWS(DESIGN, ENTRIES))
`define CTU_ID_MIRROR_BITS(DESIGN, ENTRIES, ROWS) \
  ((DESIGN) == `CTU_DESIGN_DEDUP && `CTU_ROWS_MIRROR(DESIGN, ENTRIES, ROWS) ? 3 : 0)
// Rows that a lane's test sees beside its object mask, and bits of each.
`define CTU_ROWS_OF_LANE(DESIGN) ((DESIGN) == `CTU_DESIGN_PROJECTION ? 3 : 1)
`define CTU_ROW_WIDTH(DESIGN, R, ENTRIES) \
  (`CTU_BIT_ROWS(DESIGN, ENTRIES) ? (ENTRIES) : (DESIGN) == `CTU_DESIGN_PROJECTION ? (R) * (R) : (R) * (R) * (R))
// Of a row at the load port, that of the widest table.
`define CTU_LOAD_BITS(DESIGN, R, ENTRIES) \
  (`CTU_READS_LUT(DESIGN, ENTRIES) ? (R) * (R) * (R) : \
   `CTU_ROW_WIDTH(DESIGN, R, ENTRIES) > 32 ? `CTU_ROW_WIDTH(DESIGN, R, ENTRIES) : 32)
// Rows of a memory that is read by key.
`define CTU_KEY_ROWS(DESIGN, R_RAY, ENTRIES, ROWS) \
  ((ROWS) == `CTU_ROWS_ALL ? (R_RAY) ** ((DESIGN) == `CTU_DESIGN_PROJECTION ? 4 : 6) : \
   `CTU_BIT_ROWS(DESIGN, ENTRIES) ? \
       `CTU_REVERSED_CLASSES(R_RAY) - ((ROWS) == `CTU_ROWS_REACHABLE ? `CTU_REVERSED_CLASSES((R_RAY) - 2) : 0) : \
   (DESIGN) == `CTU_DESIGN_PROJECTION ? `CTU_MIRRORED_CLASSES(2, R_RAY, 1'b1) : \
       `CTU_MIRRORED_CLASSES(3, R_RAY, 1'b1) - \
           ((ROWS) == `CTU_ROWS_REACHABLE ? `CTU_MIRRORED_CLASSES(3, (R_RAY) - 2, 1'b1) : 0))
// Bits that table_fetch brings for a lane: {entry of the compression LUT, rows or the byte of a bit row, how dedup's id
// is mirrored}.
`define CTU_FETCHED_ROW_BITS(DESIGN, R, ENTRIES) \
  ((DESIGN) == `CTU_DESIGN_COMPARATORS ? 0 : `CTU_BIT_ROWS(DESIGN, ENTRIES) ? 8 : \
   `CTU_ROW_WIDTH(DESIGN, R, ENTRIES) * `CTU_ROWS_OF_LANE(DESIGN))
`define CTU_FETCHED_BITS(DESIGN, R, ENTRIES, ROWS) \
  (`CTU_ID_MIRROR_BITS(DESIGN, ENTRIES, ROWS) + `CTU_FETCHED_ROW_BITS(DESIGN, R, ENTRIES) + \
   (`CTU_READS_LUT(DESIGN, ENTRIES) ? (R) * (R) * (R) : 0))

`endif
