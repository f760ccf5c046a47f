set(child_sort_sources ${rtl}/tokens.svh ${rtl}/float/float_compare.sv ${rtl}/pipe_control.sv ${rtl}/pipe_row.sv
  ${rtl}/child_sort.sv)
ctu_verilate(rtl_child_sort PREFIX VChildSort TOP child_sort SOURCES ${child_sort_sources} ARGS --x-initial unique)
foreach(latency IN ITEMS 1 2 7)
  ctu_verilate(rtl_child_sort PREFIX VChildSort${latency} TOP child_sort
    SOURCES ${child_sort_sources} ARGS --x-initial unique -GLATENCY=${latency})
endforeach()
rtl_mutants(child_sort_mutants TOP child_sort NAMES SortLaneTies SortDeadCount
  SOURCES ${child_sort_sources} ARGS --x-initial unique)
ctu_test(test_rtl_child_sort
  SOURCES child_sort_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_child_sort ${child_sort_mutants}
  LABEL property)
rtl_check(child_sort SOURCES ${child_sort_sources})
