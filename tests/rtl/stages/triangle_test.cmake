# The triangle test: its arithmetic at the shortest latency on hostile triangles, the stage at three latencies beside
# the model, and both broken.
set(triangle_intersect_sources ${keep_modules} ${rtl_float_sources} ${rtl}/triangle_intersect.sv)
set(triangle_test_sources ${rtl}/tokens.svh ${triangle_intersect_sources} ${rtl}/pipe_control.sv
  ${rtl}/triangle_test.sv)
ctu_verilate(rtl_triangle_intersect PREFIX VTriangleIntersect TOP triangle_intersect
  SOURCES ${triangle_intersect_sources} ARGS -GLATENCY=1)
foreach(latency IN ITEMS 1 13 45)
  ctu_verilate(rtl_triangle_test PREFIX VTriangleTest${latency} TOP triangle_test
    SOURCES ${triangle_test_sources} ARGS --x-initial unique -GLATENCY=${latency})
endforeach()
rtl_mutants(triangle_intersect_mutants TOP triangle_intersect NAMES EdgeSignOfZero EdgeOnHit TriangleRangeOpen
  SOURCES ${triangle_intersect_sources} ARGS -GLATENCY=1)
rtl_mutants(triangle_test_mutants TOP triangle_test NAMES BestAfterInterval TriangleLastEarly
  SOURCES ${triangle_test_sources} ARGS --x-initial unique -GLATENCY=1)
ctu_test(test_rtl_triangle_test
  SOURCES triangle_intersect_test.cpp triangle_test_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_triangle_intersect rtl_triangle_test ${triangle_intersect_mutants} ${triangle_test_mutants}
  LABEL property)
list(REMOVE_ITEM triangle_test_sources ${keep_modules})
rtl_check(triangle_test SOURCES ${triangle_test_sources} WORD_LEVEL)
