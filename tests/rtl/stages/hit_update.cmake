set(hit_update_sources ${rtl}/tokens.svh ${rtl}/float/float_compare.sv ${rtl}/pipe_control.sv ${rtl}/pipe_row.sv
  ${rtl}/hit_update.sv)
ctu_verilate(rtl_hit_update PREFIX VHitUpdate TOP hit_update SOURCES ${hit_update_sources} ARGS --x-initial unique)
foreach(latency IN ITEMS 1 5)
  ctu_verilate(rtl_hit_update PREFIX VHitUpdate${latency} TOP hit_update
    SOURCES ${hit_update_sources} ARGS --x-initial unique -GLATENCY=${latency})
endforeach()
rtl_mutants(hit_update_mutants TOP hit_update NAMES HitLaterWins HitBeforeUpdate
  SOURCES ${hit_update_sources} ARGS --x-initial unique)
ctu_test(test_rtl_hit_update
  SOURCES hit_update_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_hit_update ${hit_update_mutants}
  LABEL property)
rtl_check(hit_update SOURCES ${hit_update_sources})
