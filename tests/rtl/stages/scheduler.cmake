set(scheduler_sources ${rtl}/tokens.svh ${rtl}/arrival_queue.sv ${rtl}/next_in_turn.sv ${rtl}/scheduler.sv)
ctu_verilate(rtl_scheduler PREFIX VScheduler TOP scheduler SOURCES ${scheduler_sources} ARGS --x-initial unique)
rtl_mutants(scheduler_mutants TOP scheduler NAMES SchedulerNodesFirst SchedulerRaysFirst SchedulerLowestFirst
  SOURCES ${scheduler_sources} ARGS --x-initial unique)
ctu_test(test_rtl_scheduler
  SOURCES scheduler_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_scheduler ${scheduler_mutants}
  LABEL property)
rtl_check(arrival_queue SOURCES ${rtl}/arrival_queue.sv)
rtl_check(next_in_turn SOURCES ${rtl}/next_in_turn.sv)
rtl_check(scheduler SOURCES ${scheduler_sources})
