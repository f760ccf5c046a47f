set(box_test_stage_sources ${keep_modules} ${rtl}/tokens.svh ${rtl_float_sources} ${box_test_sources}
  ${rtl}/pipe_control.sv ${rtl}/box_test.sv)
ctu_verilate(rtl_box_test PREFIX VBoxTest TOP box_test SOURCES ${box_test_stage_sources} ARGS --x-initial unique)
# Without the inner bounds, and at the latencies whose shares differ most from the default's.
foreach(latency IN ITEMS 1 6 25)
  ctu_verilate(rtl_box_test_outer_${latency} PREFIX VBoxTestOuter${latency} TOP box_test
    SOURCES ${box_test_stage_sources} ARGS --x-initial unique -GINNER=0 -GLATENCY=${latency})
  target_compile_options(rtl_box_test_outer_${latency} PRIVATE -O1)
endforeach()
rtl_mutants(box_test_mutants TOP box_test NAMES BoxAxesSwapped BoxSlotEarly SOURCES ${box_test_stage_sources}
  ARGS --x-initial unique -GINNER=0 -GLATENCY=6)
ctu_test(test_rtl_box_test
  SOURCES box_test_test.cpp ../../intersect/hostile_boxes.cpp
  DEPENDS ctu_pipeline_test_support rtl_box_test rtl_box_test_outer_1 rtl_box_test_outer_6 rtl_box_test_outer_25
    ${box_test_mutants}
  LABEL property)
rtl_check(box_test SOURCES ${rtl_float_sources} ${box_test_sources} ${rtl}/tokens.svh ${rtl}/pipe_control.sv
  ${rtl}/box_test.sv)
