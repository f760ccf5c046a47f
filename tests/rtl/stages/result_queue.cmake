set(result_queue_sources ${rtl}/tokens.svh ${rtl}/result_queue.sv)
ctu_verilate(rtl_result_queue PREFIX VResultQueue TOP result_queue
  SOURCES ${result_queue_sources} ARGS --x-initial unique)
rtl_mutants(result_queue_mutants TOP result_queue NAMES ResultRaysFirst ResultIntervalLate
  SOURCES ${result_queue_sources} ARGS --x-initial unique)
ctu_test(test_rtl_result_queue
  SOURCES result_queue_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_result_queue ${result_queue_mutants}
  LABEL property)
rtl_check(result_queue SOURCES ${result_queue_sources})
