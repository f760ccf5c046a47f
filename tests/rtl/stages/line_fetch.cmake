set(line_fetch_sources ${rtl}/tokens.svh ${rtl}/arrival_queue.sv ${rtl}/next_in_turn.sv ${rtl}/cache_tags.sv
  ${rtl}/cache_data.sv ${rtl}/miss_registers.sv ${rtl}/line_fetch.sv)
set(span_fetch_sources ${line_fetch_sources} ${rtl}/line_buffer.sv ${rtl}/span_fetch.sv)

# Both fetches of spans: masks of 64 bits and one port, indices and two ports, no masks and four ports with few bytes in
# a line. Wide lines as loops, not word by word: a third of the code to compile. All begin from noise.
set(fetch_bench ${CMAKE_CURRENT_SOURCE_DIR}/fetch_bench.sv)
set(fetch_bench_sources ${fetch_bench} ${span_fetch_sources} ${rtl}/node_fetch.sv ${rtl}/leaf_fetch.sv)
set(compact --expand-limit 4 --x-initial unique)
set(four_ports -GLINE_BYTES=32 -GPORTS=4 -GMASK_BITS=0)
ctu_verilate(rtl_fetch_one_port PREFIX VFetchOnePort TOP fetch_bench SOURCES ${fetch_bench_sources}
  ARGS ${compact} -GMAX_MSHRS=16)
ctu_verilate(rtl_fetch_two_ports PREFIX VFetchTwoPorts TOP fetch_bench SOURCES ${fetch_bench_sources}
  ARGS ${compact} -GLINE_BYTES=64 -GPORTS=2 -GMASK_BITS=6)
ctu_verilate(rtl_fetch_four_ports PREFIX VFetchFourPorts TOP fetch_bench SOURCES ${fetch_bench_sources}
  ARGS ${compact} ${four_ports})
rtl_mutants(fetch_mutants TOP fetch_bench
  NAMES FetchTwoRequests FetchFirstInFirstOut FetchHighestRegister FetchTurnStays FetchReadsUncounted
  SOURCES ${fetch_bench_sources} ARGS ${compact} ${four_ports} -GMAX_SETS=4 -GMAX_WAYS=4)
ctu_test(test_rtl_fetch
  SOURCES line_fetch_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_fetch_one_port rtl_fetch_two_ports rtl_fetch_four_ports ${fetch_mutants}
  LABEL property)

rtl_check(cache_tags SOURCES ${rtl}/cache_tags.sv)
rtl_check(cache_data SOURCES ${rtl}/cache_data.sv)
rtl_check(miss_registers SOURCES ${rtl}/miss_registers.sv)
rtl_check(line_fetch SOURCES ${line_fetch_sources})
rtl_check(line_buffer SOURCES ${rtl}/line_buffer.sv WORD_LEVEL)
rtl_check(span_fetch SOURCES ${span_fetch_sources} WORD_LEVEL)
rtl_check(node_fetch SOURCES ${span_fetch_sources} ${rtl}/node_fetch.sv WORD_LEVEL)
rtl_check(leaf_fetch SOURCES ${span_fetch_sources} ${rtl}/leaf_fetch.sv WORD_LEVEL)
