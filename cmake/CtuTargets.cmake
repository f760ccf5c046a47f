# One way to declare a library, a test and a benchmark, so that the flags which
# decide bits (no contraction, no fast math) cannot be forgotten on any target.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3")

find_program(CTU_CCACHE ccache)
if(CTU_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CTU_CCACHE})
endif()

add_library(ctu_options INTERFACE)
target_compile_options(ctu_options INTERFACE -ffp-contract=off -Wall -Wextra)
if(CTU_NATIVE)
  target_compile_options(ctu_options INTERFACE -march=native)
endif()
if(CTU_SANITIZE)
  target_compile_options(ctu_options INTERFACE -fsanitize=${CTU_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(ctu_options INTERFACE -fsanitize=${CTU_SANITIZE})
endif()
if(CTU_FUZZ)
  target_compile_options(ctu_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
target_include_directories(ctu_options INTERFACE ${PROJECT_SOURCE_DIR})

# ctu_library(name SOURCES a.cpp ... DEPENDS ctu_x fmt::fmt ... [PRIVATE_DEPENDS ...])
# A library without sources is an interface library (headers only).
function(ctu_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  if(ARG_SOURCES)
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC ctu_options ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS})
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ctu_options ${ARG_DEPENDS})
  endif()
endfunction()

# ctu_test(name SOURCES a.cpp ... DEPENDS ... LABEL unit|property|oracle|end-to-end [TIMEOUT seconds])
# One GoogleTest program, compiled with CTU_TEST_FLAGS of its folder; every test of it is a ctest of its own, labelled.
function(ctu_test name)
  cmake_parse_arguments(ARG "" "LABEL;TIMEOUT" "SOURCES;DEPENDS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ctu_options ${ARG_DEPENDS} GTest::gtest_main)
  target_compile_options(${name} PRIVATE ${CTU_TEST_FLAGS})
  target_compile_definitions(${name} PRIVATE CTU_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  gtest_discover_tests(${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
endfunction()

# ctu_benchmark(name SOURCES a.cpp ... DEPENDS ...): a Google Benchmark program; not a test.
function(ctu_benchmark name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ctu_options ${ARG_DEPENDS} benchmark::benchmark)
endfunction()
