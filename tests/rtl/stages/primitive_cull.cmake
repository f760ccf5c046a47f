# primitive_cull beside the model's, with each number of boxes a cycle and latencies from 1 on, and broken.
set(primitive_cull_sources ${rtl}/tokens.svh ${rtl_float_sources} ${rtl}/pipe_control.sv ${rtl}/ray_box_axis.sv
  ${rtl}/primitive_cull.sv)
foreach(shape IN ITEMS 1=1 2=4 3=10 4=23)
  string(REGEX MATCH "^(.)=(.*)$" whole ${shape})
  set(units ${CMAKE_MATCH_1})
  set(latency ${CMAKE_MATCH_2})
  ctu_verilate(rtl_primitive_cull PREFIX VPrimitiveCull${units} TOP primitive_cull
    SOURCES ${keep_modules} ${primitive_cull_sources} ARGS --x-initial unique -GUNITS=${units} -GLATENCY=${latency})
endforeach()
rtl_mutants(primitive_cull_mutants TOP primitive_cull NAMES RayBoxInward RayBoxTwoAxes
  SOURCES ${keep_modules} ${primitive_cull_sources} ARGS --x-initial unique -GUNITS=1 -GLATENCY=1)
ctu_test(test_rtl_primitive_cull
  SOURCES primitive_cull_test.cpp
  DEPENDS ctu_pipeline_test_support ctu_test_support rtl_primitive_cull ${primitive_cull_mutants}
  LABEL property)
rtl_check(primitive_cull SOURCES ${primitive_cull_sources} WORD_LEVEL)
rtl_check(primitive_cull SOURCES ${primitive_cull_sources} VARIANT four PARAMETERS UNITS=4 LATENCY=1)
