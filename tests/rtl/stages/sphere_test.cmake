# The sphere test: its arithmetic at the shortest latency on hostile spheres, the stage at three latencies beside the
# model, and both broken.
set(sphere_intersect_sources ${keep_modules} ${rtl_float_sources} ${rtl}/sphere_intersect.sv)
set(sphere_test_sources ${rtl}/tokens.svh ${sphere_intersect_sources} ${rtl}/pipe_control.sv ${rtl}/sphere_test.sv)
ctu_verilate(rtl_sphere_intersect PREFIX VSphereIntersect TOP sphere_intersect
  SOURCES ${sphere_intersect_sources} ARGS -GLATENCY=1)
foreach(latency IN ITEMS 1 21 89)
  ctu_verilate(rtl_sphere_test PREFIX VSphereTest${latency} TOP sphere_test
    SOURCES ${sphere_test_sources} ARGS --x-initial unique -GLATENCY=${latency})
endforeach()
rtl_mutants(sphere_mutants TOP sphere_intersect NAMES SphereGrazedMisses SphereNoFarEnd
  SOURCES ${sphere_intersect_sources} ARGS -GLATENCY=1)
ctu_test(test_rtl_sphere_test
  SOURCES sphere_intersect_test.cpp sphere_test_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_sphere_intersect rtl_sphere_test ${sphere_mutants}
  LABEL property)
list(REMOVE_ITEM sphere_test_sources ${keep_modules})
rtl_check(sphere_test SOURCES ${sphere_test_sources} WORD_LEVEL)
