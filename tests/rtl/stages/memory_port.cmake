set(memory_port_sources ${rtl}/tokens.svh ${rtl}/next_in_turn.sv ${rtl}/memory_port.sv)
ctu_verilate(rtl_memory_port PREFIX VMemoryPort4 TOP memory_port SOURCES ${memory_port_sources}
  ARGS -GCLIENTS=4 -GADDRESS_BITS=40 --x-initial unique)
ctu_verilate(rtl_memory_port PREFIX VMemoryPort2 TOP memory_port SOURCES ${memory_port_sources}
  ARGS -GCLIENTS=2 -GADDRESS_BITS=40 --x-initial unique)
rtl_mutants(port_mutants TOP memory_port NAMES PortWaitsForAll PortTurnStays PortPushesUnasked
  SOURCES ${memory_port_sources} ARGS -GCLIENTS=4 -GADDRESS_BITS=40 --x-initial unique)
ctu_test(test_rtl_memory_port
  SOURCES memory_port_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_memory_port ${port_mutants}
  LABEL property)
rtl_check(memory_port SOURCES ${memory_port_sources})
