# packet_cull: its lane on hostile packets; the stage beside the model's, with each number of lanes, entries from 1 to 16,
# latencies from 1 on, boxes of reduced precision; and broken ones.
set(packet_lane_sources ${rtl}/packet_bounds.svh ${rtl}/slab_bound.sv ${rtl}/slab_overlap.sv ${rtl}/packet_slab_axis.sv
  ${rtl}/packet_join.sv ${rtl}/packet_test_lane.sv)
set(packet_lane_bench ${keep_modules} ${CMAKE_CURRENT_SOURCE_DIR}/packet_lane_bench.sv ${rtl_float_sources}
  ${packet_lane_sources})
ctu_verilate(rtl_packet_lane PREFIX VPacketLane TOP packet_lane_bench SOURCES ${packet_lane_bench}
  ARGS --x-initial unique)
rtl_mutants(packet_lane_mutants TOP packet_lane_bench NAMES PacketOriginsSwapped SOURCES ${packet_lane_bench}
  ARGS --x-initial unique)
ctu_test(test_rtl_packet_lane
  SOURCES packet_lane_test.cpp
  DEPENDS ctu_check ctu_pipeline_test_support rtl_packet_lane ${packet_lane_mutants}
  LABEL property)

set(packet_cull_sources ${rtl}/tokens.svh ${rtl_float_sources} ${packet_lane_sources} ${box_decode_sources}
  ${rtl}/arrival_queue.sv ${rtl}/context_file.sv ${rtl}/entry_search.sv ${rtl}/pipe_control.sv ${rtl}/packet_cull.sv)
# packet_cull_model(name arguments of the module, -D of mutations ...)
function(packet_cull_model name)
  ctu_verilate(rtl_packet_cull_models PREFIX V${name} TOP packet_cull SOURCES ${keep_modules} ${packet_cull_sources} ARGS
    --x-initial unique ${ARGN})
endfunction()
packet_cull_model(PacketCull)
packet_cull_model(PacketCullParallel -GMIN_INTERVAL=1 -GLATENCY=1 -GPACKETS=1 -GENTRIES=1)
packet_cull_model(PacketCullCompact -GMIN_INTERVAL=2 -GLATENCY=25 -GPACKETS=5 -GENTRIES=16 -GBOX_BITS=12
  -GDECODE_LATENCY=2 -GTREES=3)
packet_cull_model(MutantPacketDoubts -GMIN_INTERVAL=3 -GLATENCY=2 -DCTU_MUTATE_PACKET_DOUBTS)
ctu_test(test_rtl_packet_cull
  SOURCES packet_cull_test.cpp
  DEPENDS ctu_pipeline_test_support ctu_test_support rtl_packet_cull_models
  LABEL property)

# What it is made of is checked with it. The other stages that have more to do where rays travel in packets are checked in
# the whole unit's structures, and the stack's second source of entries here.
rtl_check(packet_cull SOURCES ${packet_cull_sources} VARIANT compact
  PARAMETERS BOX_BITS=8 MIN_INTERVAL=1 LATENCY=1 PACKETS=3 ENTRIES=5 TREES=2)
rtl_check(traversal_stack SOURCES ${traversal_stack_sources} VARIANT packets
  PARAMETERS MAX_ENTRIES=4 PACKETS=2 PACKET_ENTRIES=5)
