# The mask test, a model for each structure.
set(mask_test_sources ${rtl}/table_bank.sv ${rtl}/table_turns.sv ${rtl}/table_memory.sv ${lane_rows_sources}
  ${rtl}/mask_mirror.sv ${rtl}/mask_lane.sv)
set(mask_test_headers ${rtl}/mask_designs.svh ${rtl}/key_fold.svh ${rtl}/tokens.svh)
# mask_test_model(Name PARAMETER=value ...)
function(mask_test_model name)
  list(TRANSFORM ARGN PREPEND -G OUTPUT_VARIABLE parameters)
  ctu_verilate(rtl_mask_test_models PREFIX VMaskTest${name} TOP mask_test
    SOURCES ${mask_test_headers} ${rtl_flow_sources} ${mask_test_sources} ${rtl}/mask_test.sv
    ARGS --x-initial unique ${parameters})
endfunction()

mask_test_model(Projection DESIGN=5 R=4 R_RAY=4 BANKS=4 PORTS=1 LATENCY=2)
mask_test_model(OneProjection DESIGN=5 R=4 R_RAY=6 PROJECTION_TABLES=1 BANKS=2 PORTS=3 LATENCY=4)
mask_test_model(MaskLut DESIGN=2 R=4 R_RAY=4 BANKS=1 PORTS=1 LATENCY=1)
mask_test_model(Comparators DESIGN=6 R=4 LATENCY=2)
mask_test_model(Dedup DESIGN=4 R=4 R_RAY=4 DISTINCT=1270 BANKS=1 PORTS=2 LATENCY=1 SECOND_LATENCY=1)
mask_test_model(BitTable DESIGN=3 R=4 R_RAY=4 ENTRIES=300 MASK_BITS=6 BANKS=2 PORTS=1 LATENCY=2)
mask_test_model(DedupCompressed DESIGN=4 R=3 R_RAY=5 ENTRIES=300 DISTINCT=2500 BANKS=2 PORTS=1 LATENCY=2
  SECOND_LATENCY=3)
mask_test_model(ProjectionCompressed DESIGN=5 R=6 R_RAY=6 ENTRIES=256 BANKS=8 PORTS=1 LATENCY=2)
mask_test_model(ComparatorsCompressed DESIGN=6 R=4 ENTRIES=32 BANKS=1 PORTS=1 LATENCY=3)
mask_test_model(ProjectionFolded DESIGN=5 R=3 R_RAY=5 ROWS=1)
mask_test_model(MaskLutReachable DESIGN=2 R=4 R_RAY=6 ROWS=2 BANKS=2 PORTS=2 LATENCY=3)
mask_test_model(DedupFolded DESIGN=4 R=4 R_RAY=5 ROWS=1 DISTINCT=700)
mask_test_model(BitTableReachable DESIGN=3 R=4 R_RAY=5 ROWS=2 ENTRIES=64 BANKS=4 PORTS=1)
mask_test_model(ProjectionCached DESIGN=5 R=4 R_RAY=4 ENTRIES=64 CACHED=1'b1)
mask_test_model(DedupCached DESIGN=4 R=4 R_RAY=5 ROWS=1 CACHED=1'b1 LATENCY=1)
mask_test_model(BitTableCached DESIGN=3 R=4 R_RAY=5 ROWS=2 ENTRIES=64 CACHED=1'b1 LATENCY=3)

rtl_mutants(mask_test_mutants TOP mask_test NAMES UnsharedReads RowsNotKept IdNotMirrored SecondTurnsForgotten
  SOURCES ${mask_test_headers} ${rtl_flow_sources} ${mask_test_sources} ${rtl}/mask_test.sv
  ARGS -GDESIGN=4 -GROWS=1 -GDISTINCT=700 -GBANKS=1 -GLATENCY=1)

# Each fold for a few resolutions of rays.
ctu_verilate(rtl_fold_bench PREFIX VFoldBench TOP fold_bench
  SOURCES ${mask_test_headers} ${rtl}/key_fold.svh ${rtl}/mirror_fold.sv ${rtl}/reverse_fold.sv
    ${CMAKE_CURRENT_SOURCE_DIR}/fold_bench.sv)
ctu_test(test_rtl_key_fold SOURCES key_fold_test.cpp DEPENDS ctu_cull ctu_oracle rtl_fold_bench LABEL property)

ctu_test(test_rtl_mask_test
  SOURCES mask_test_test.cpp
  DEPENDS ctu_pipeline_test_support ctu_oracle rtl_mask_test_models ${mask_test_mutants}
  LABEL property)

foreach(module IN ITEMS table_bank table_turns mirror_fold reverse_fold mask_mirror)
  rtl_check(${module} SOURCES ${rtl}/${module}.sv)
endforeach()
rtl_check(table_memory SOURCES ${rtl}/table_bank.sv ${rtl}/table_turns.sv ${rtl}/table_memory.sv)
rtl_check(key_row SOURCES ${rtl}/mirror_fold.sv ${rtl}/reverse_fold.sv ${rtl}/key_row.sv)
rtl_check(mask_lane SOURCES ${rtl}/mask_mirror.sv ${rtl}/mask_lane.sv)
set(mask_test_checked SOURCES ${rtl_flow_sources} ${mask_test_sources} ${rtl}/mask_test.sv)
rtl_check(mask_test ${mask_test_checked} WORD_LEVEL)
# Each structure once, with small tables.
set(small R=2 R_RAY=2 DISTINCT=50)
foreach(design IN ITEMS mask-lut=2 dedup=4 comparators=6)
  string(REPLACE = ";" name_and_number ${design})
  list(GET name_and_number 0 name)
  list(GET name_and_number 1 number)
  rtl_check(mask_test ${mask_test_checked} VARIANT ${name} PARAMETERS ${small} DESIGN=${number})
  rtl_check(mask_test ${mask_test_checked} VARIANT ${name}.compressed PARAMETERS ${small} DESIGN=${number} ENTRIES=20)
endforeach()
rtl_check(mask_test ${mask_test_checked} VARIANT bit-table PARAMETERS ${small} DESIGN=3 ENTRIES=20)
rtl_check(mask_test ${mask_test_checked} VARIANT bit-table.reachable PARAMETERS R=2 R_RAY=3 ROWS=2 DESIGN=3 ENTRIES=20)
rtl_check(mask_test ${mask_test_checked} VARIANT dedup.folded PARAMETERS R=2 R_RAY=3 ROWS=1 DESIGN=4 DISTINCT=50)
rtl_check(mask_test ${mask_test_checked} VARIANT dedup.cached PARAMETERS R=2 R_RAY=3 ROWS=1 DESIGN=4 CACHED=1'b1)
rtl_check(mask_test ${mask_test_checked} VARIANT projection.folded PARAMETERS R=2 R_RAY=3 ROWS=1)
rtl_check(mask_test ${mask_test_checked} VARIANT projection.compressed
  PARAMETERS ${small} DESIGN=5 ENTRIES=20 BANKS=1 PORTS=3 PROJECTION_TABLES=1)
