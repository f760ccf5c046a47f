# The decoder of boxes of reduced precision: without registers, and broken.
set(box_decode_sources ${rtl}/box_decode_plane.sv ${rtl}/box_decode.sv)
foreach(bits IN ITEMS 8 12 16)
  ctu_verilate(rtl_box_decode PREFIX VBoxDecode${bits} TOP box_decode
    SOURCES ${keep_modules} ${rtl_float_sources} ${box_decode_sources} ARGS -GBITS=${bits} -GLATENCY=0)
endforeach()
rtl_check(box_decode SOURCES ${rtl_float_sources} ${box_decode_sources})
rtl_check(box_decode SOURCES ${rtl_float_sources} ${box_decode_sources} VARIANT 8 PARAMETERS BITS=8 LATENCY=1)
rtl_mutants(box_decode_mutants TOP box_decode NAMES DecodeNormalOnly DecodeToNearest DecodeUnlimited
  SOURCES ${keep_modules} ${rtl_float_sources} ${box_decode_sources} ARGS -GBITS=8 -GLATENCY=0)
ctu_test(test_rtl_box_decode
  SOURCES box_decode_test.cpp
  DEPENDS ctu_accel ctu_oracle fmt::fmt rtl_box_decode ${box_decode_mutants}
  LABEL property)

set(box_test_stage_sources ${keep_modules} ${rtl}/tokens.svh ${rtl_float_sources} ${box_test_sources}
  ${box_decode_sources} ${rtl}/pipe_control.sv ${rtl}/box_test.sv)
ctu_verilate(rtl_box_test PREFIX VBoxTest TOP box_test SOURCES ${box_test_stage_sources} ARGS --x-initial unique)
# Without the inner bounds, and at the latencies whose shares differ most from the default's.
foreach(latency IN ITEMS 1 6 25)
  ctu_verilate(rtl_box_test_outer PREFIX VBoxTestOuter${latency} TOP box_test
    SOURCES ${box_test_stage_sources} ARGS --x-initial unique -GINNER=0 -GLATENCY=${latency})
endforeach()
# Boxes decoded in front of the test.
ctu_verilate(rtl_box_test_compact PREFIX VBoxTestCompact TOP box_test
  SOURCES ${box_test_stage_sources} ARGS --x-initial unique -GINNER=0 -GLATENCY=3 -GBOX_BITS=12 -GDECODE_LATENCY=2)
rtl_mutants(box_test_mutants TOP box_test NAMES BoxAxesSwapped BoxSlotEarly SOURCES ${box_test_stage_sources}
  ARGS --x-initial unique -GINNER=0 -GLATENCY=6)
ctu_test(test_rtl_box_test
  SOURCES box_test_test.cpp ../../intersect/hostile_boxes.cpp
  DEPENDS ctu_pipeline_test_support rtl_box_test rtl_box_test_outer
    rtl_box_test_compact ${box_test_mutants}
  LABEL property)
set(box_test_checked ${rtl_float_sources} ${box_test_sources} ${box_decode_sources} ${rtl}/tokens.svh
  ${rtl}/pipe_control.sv ${rtl}/box_test.sv)
rtl_check(box_test SOURCES ${box_test_checked} WORD_LEVEL)
rtl_check(box_test SOURCES ${box_test_checked} VARIANT boxes-8 PARAMETERS BOX_BITS=8)
