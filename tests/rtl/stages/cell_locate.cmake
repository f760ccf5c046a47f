set(plane_times_sources ${rtl_float_sources} ${rtl}/float/float_fraction.sv ${rtl}/float/float_key.sv ${rtl}/plane_times.sv)
set(locate_lane_sources ${plane_times_sources} ${rtl}/cell_locate_axis.sv ${rtl}/cell_locate_lane.sv)
set(comparator_lane_sources ${plane_times_sources} ${rtl}/comparator_axis.sv ${rtl}/comparator_lane.sv)
set(cell_locate_sources ${rtl}/tokens.svh ${rtl}/pipe_control.sv ${locate_lane_sources} ${rtl}/comparator_axis.sv
  ${rtl}/comparator_lane.sv ${rtl}/cell_locate.sv)

ctu_verilate(rtl_cell_locate_1 PREFIX VCellLocate1 TOP cell_locate SOURCES ${keep_modules} ${cell_locate_sources})
ctu_verilate(rtl_cell_locate_2 PREFIX VCellLocate2 TOP cell_locate SOURCES ${keep_modules} ${cell_locate_sources}
  ARGS -GR_RAY=6 -GUNITS=2 -GLATENCY=1)
ctu_verilate(rtl_cell_locate_4 PREFIX VCellLocate4 TOP cell_locate SOURCES ${keep_modules} ${cell_locate_sources}
  ARGS -GR_RAY=5 -GUNITS=4 -GLATENCY=23)
ctu_verilate(rtl_cell_locate_masks_2 PREFIX VCellLocateMasks2 TOP cell_locate
  SOURCES ${keep_modules} ${cell_locate_sources} ARGS -GCOMPARATORS=1 -GR=3 -GUNITS=2 -GLATENCY=3)
ctu_verilate(rtl_cell_locate_masks_3 PREFIX VCellLocateMasks3 TOP cell_locate
  SOURCES ${keep_modules} ${cell_locate_sources} ARGS -GCOMPARATORS=1 -GUNITS=3 -GLATENCY=12)
rtl_mutants(cell_locate_mutants TOP cell_locate NAMES CellLocateFullLanesAsked CellLocateEntranceAlwaysFree
  SOURCES ${keep_modules} ${cell_locate_sources})
ctu_test(test_rtl_cell_locate
  SOURCES cell_locate_test.cpp
  DEPENDS ctu_pipeline_test_support rtl_cell_locate_1 rtl_cell_locate_2 rtl_cell_locate_4 rtl_cell_locate_masks_2
    rtl_cell_locate_masks_3 ${cell_locate_mutants}
  LABEL property)

# The lanes by themselves, of several resolutions side by side, and broken ones.
set(locate_lanes_bench ${keep_modules} ${CMAKE_CURRENT_SOURCE_DIR}/locate_lanes_bench.sv)
list(APPEND locate_lanes_bench ${locate_lane_sources} ${rtl}/comparator_axis.sv ${rtl}/comparator_lane.sv)
ctu_verilate(rtl_locate_lanes PREFIX VLocateLanes TOP locate_lanes_bench SOURCES ${locate_lanes_bench})
rtl_mutants(locate_lane_mutants TOP locate_lanes_bench NAMES WeightInwards FractionSticky PlanesMetArePassed FlatBox
  NoColumn CellsNeverTouched KeysOfZeros
  SOURCES ${locate_lanes_bench} ARGS -GFEW=1'b1)
ctu_test(test_rtl_locate_lanes
  SOURCES locate_lanes_test.cpp ../../intersect/hostile_boxes.cpp
  DEPENDS ctu_cull ctu_intersect ctu_oracle rtl_locate_lanes ${locate_lane_mutants}
  LABEL property)

# What these are made of is checked within them.
rtl_check(float_fraction SOURCES ${rtl_float_sources} ${rtl}/float/float_fraction.sv)
rtl_check(float_key SOURCES ${rtl}/float/float_key.sv)
rtl_check(comparator_lane SOURCES ${comparator_lane_sources} WORD_LEVEL)
rtl_check(cell_locate SOURCES ${cell_locate_sources} WORD_LEVEL)
