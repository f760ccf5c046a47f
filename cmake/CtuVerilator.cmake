# Verilated models of rtl/. Without Verilator everything else is built as ever, and a line at configuration says so.
option(CTU_RTL "Build and check the SystemVerilog twin, where Verilator is there" ON)
find_program(CTU_VERILATOR verilator)
find_program(CTU_YOSYS yosys)
mark_as_advanced(CTU_VERILATOR CTU_YOSYS)

set(CTU_RTL_CHECKED OFF)
if(NOT CTU_RTL)
  message(STATUS "RTL: switched off (CTU_RTL)")
elseif(NOT CTU_VERILATOR)
  message(STATUS "RTL: no Verilator here, so rtl/ is not checked (Debian: apt-get install verilator)")
else()
  set(CTU_RTL_CHECKED ON)
  execute_process(COMMAND ${CTU_VERILATOR} --getenv VERILATOR_ROOT
    OUTPUT_VARIABLE CTU_VERILATOR_ROOT OUTPUT_STRIP_TRAILING_WHITESPACE)
  message(STATUS "RTL: checked with ${CTU_VERILATOR}")
  if(NOT CTU_YOSYS)
    message(STATUS "RTL: no yosys here, so rtl/ is not synthesised (Debian: apt-get install yosys)")
  endif()
endif()

# Writes the C++ of all models, for tools that read sources without building them.
add_custom_target(rtl_sources)

# Verilator's own runtime, once for all models. Its warnings are not ours.
function(ctu_verilator_runtime)
  set(include ${CTU_VERILATOR_ROOT}/include)
  add_library(ctu_verilated STATIC ${include}/verilated.cpp ${include}/verilated_threads.cpp)
  target_include_directories(ctu_verilated SYSTEM PUBLIC ${include} ${include}/vltstd)
  target_compile_options(ctu_verilated PRIVATE -w)
  set_target_properties(ctu_verilated PROPERTIES POSITION_INDEPENDENT_CODE ON)  # models may be loaded at run time
  target_link_libraries(ctu_verilated PUBLIC Threads::Threads)
endfunction()

# For a library whose model counts its coverage: the counters' part of the runtime, and what says that it is there.
function(ctu_verilator_coverage_runtime library)
  if(NOT TARGET ctu_verilated_coverage)
    add_library(ctu_verilated_coverage STATIC EXCLUDE_FROM_ALL ${CTU_VERILATOR_ROOT}/include/verilated_cov.cpp)
    target_compile_options(ctu_verilated_coverage PRIVATE -w)
    set_target_properties(ctu_verilated_coverage PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(ctu_verilated_coverage PUBLIC ctu_verilated)
  endif()
  target_compile_definitions(${library} PRIVATE VM_COVERAGE=1)
  target_link_libraries(${library} PRIVATE ctu_verilated_coverage)
endfunction()

# ctu_verilate(library PREFIX Vname TOP module SOURCES a.sv ... [ARGS -DX -GY=1 ...])
# One model as a static library; `#include "Vname.h"`. Further calls add models to the same library. All of its C++ is
# one translation unit, as reading Verilator's headers takes longer than compiling a small model, and is compiled with
# CTU_VERILATED_FLAGS of the folder that asks for it first.
function(ctu_verilate library)
  cmake_parse_arguments(ARG "" "PREFIX;TOP" "SOURCES;ARGS" ${ARGN})
  if(NOT TARGET ctu_verilated)
    ctu_verilator_runtime()
  endif()
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${ARG_PREFIX})
  add_custom_command(
    OUTPUT ${folder}/all.cpp ${folder}/${ARG_PREFIX}.h
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${folder}  # its files' names depend on the sources: no old one may stay
    COMMAND ${CTU_VERILATOR} --cc -O3 -I${PROJECT_SOURCE_DIR}/rtl
      -I${PROJECT_SOURCE_DIR}/rtl/float --Mdir ${folder} --prefix ${ARG_PREFIX}
      --top-module ${ARG_TOP} ${ARG_ARGS} ${ARG_SOURCES}
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${folder} -P ${PROJECT_SOURCE_DIR}/cmake/JoinVerilated.cmake
    DEPENDS ${ARG_SOURCES} ${PROJECT_SOURCE_DIR}/cmake/JoinVerilated.cmake
    COMMENT "Verilating ${ARG_TOP} as ${ARG_PREFIX}"
    VERBATIM)
  if(NOT TARGET ${library})
    add_library(${library} STATIC)
    target_compile_options(${library} PRIVATE -w ${CTU_VERILATED_FLAGS})
    target_link_libraries(${library} PUBLIC ctu_verilated)
  else()
    set_target_properties(${library} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  endif()
  target_sources(${library} PRIVATE ${folder}/all.cpp ${folder}/${ARG_PREFIX}.h)
  target_include_directories(${library} SYSTEM PUBLIC ${folder})
  add_custom_target(${ARG_PREFIX}_sources DEPENDS ${folder}/all.cpp)
  add_dependencies(${library} ${ARG_PREFIX}_sources)
  add_dependencies(rtl_sources ${ARG_PREFIX}_sources)
endfunction()
