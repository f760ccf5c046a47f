# The table fetch, a model for each structure.
set(lane_rows_sources ${rtl}/mirror_fold.sv ${rtl}/reverse_fold.sv ${rtl}/key_row.sv ${rtl}/lane_rows.sv)
set(table_fetch_sources ${rtl}/mask_designs.svh ${rtl}/key_fold.svh ${lane_rows_sources} ${line_fetch_sources}
  ${rtl}/row_buffer.sv ${rtl}/table_fetch.sv)
set(table_fetch_args ${compact} -GSLOT_BITS=4 -GMAX_SETS=8 -GMAX_WAYS=4 -GMAX_HIT_LATENCY=5)
# table_fetch_model(Name PARAMETER=value ...)
function(table_fetch_model name)
  list(TRANSFORM ARGN PREPEND -G OUTPUT_VARIABLE parameters)
  ctu_verilate(rtl_table_fetch_models PREFIX VTableFetch${name} TOP table_fetch SOURCES ${table_fetch_sources}
    ARGS ${table_fetch_args} ${parameters})
endfunction()

table_fetch_model(Projection DESIGN=5 ENTRIES=64)
table_fetch_model(OneProjection DESIGN=5 R=6 R_RAY=6 ROWS=1 PROJECTION_TABLES=1 PORTS=3 LINE_BYTES=64)
table_fetch_model(MaskLut DESIGN=2 PORTS=2)
table_fetch_model(Dedup DESIGN=4 R_RAY=5 ROWS=1 DISTINCT=700 PORTS=2)
table_fetch_model(DedupCompressed DESIGN=4 ENTRIES=300 PORTS=4)
table_fetch_model(BitTable DESIGN=3 R_RAY=5 ROWS=2 ENTRIES=64)
table_fetch_model(Comparators DESIGN=6 R=7 ENTRIES=32 PORTS=2)
rtl_mutants(table_fetch_mutants TOP table_fetch NAMES FetchSecondRoundLast TableLinesRepeated RowOffsetIgnored
  SOURCES ${table_fetch_sources} ARGS ${table_fetch_args} -GDESIGN=4 -GR_RAY=5 -GROWS=1 -GDISTINCT=700 -GPORTS=2)
ctu_test(test_rtl_table_fetch
  SOURCES table_fetch_test.cpp
  DEPENDS ctu_cosim ctu_pipeline_test_support rtl_table_fetch_models ${table_fetch_mutants}
  LABEL property)

rtl_check(lane_rows SOURCES ${lane_rows_sources})
rtl_check(row_buffer SOURCES ${rtl}/row_buffer.sv)
# Each structure once, with small tables.
set(table_fetch_checked SOURCES ${table_fetch_sources})
rtl_check(table_fetch ${table_fetch_checked} WORD_LEVEL)
rtl_check(table_fetch ${table_fetch_checked} VARIANT projection.compressed
  PARAMETERS R=2 R_RAY=2 ENTRIES=20 PROJECTION_TABLES=1 PORTS=2)
rtl_check(table_fetch ${table_fetch_checked} VARIANT mask-lut.wide PARAMETERS DESIGN=2 R=7 R_RAY=2 PORTS=2)
rtl_check(table_fetch ${table_fetch_checked} VARIANT bit-table.reachable
  PARAMETERS DESIGN=3 R=2 R_RAY=3 ROWS=2 ENTRIES=20)
rtl_check(table_fetch ${table_fetch_checked} VARIANT dedup.folded PARAMETERS DESIGN=4 R=2 R_RAY=3 ROWS=1 DISTINCT=50)
rtl_check(table_fetch ${table_fetch_checked} VARIANT dedup.compressed
  PARAMETERS DESIGN=4 R=2 R_RAY=2 ENTRIES=20 DISTINCT=50)
rtl_check(table_fetch ${table_fetch_checked} VARIANT comparators PARAMETERS DESIGN=6 R=2 ENTRIES=20)
