# Every module is one CMake target; all targets compile by the same rules.

# Our own targets link ttf_options privately: an embedding project gets none of these flags.
add_library(ttf_options INTERFACE)
# Results have the same bits at every optimisation level, so contraction is off. -mno-fma is needed besides: g++ 12's vectoriser
# joins a*b-c*d, a*b+c*d into vfmaddsub all the same, and Eigen's packets must round as its scalars do. The presets
# (CMakePresets.json) choose the instruction set and which warnings are errors; kept hashes are those of x86-64-v3.
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(-mno-fma TTF_HAS_NO_FMA_OPTION)   # of x86 alone
target_compile_options(ttf_options INTERFACE $<$<BOOL:${TTF_HAS_NO_FMA_OPTION}>:-mno-fma> -ffp-contract=off -pthread)
target_include_directories(ttf_options INTERFACE ${PROJECT_SOURCE_DIR})
# Eigen aligns by the instruction set that it is compiled for, and types with its members have another layout for each. So the
# alignment is that of x86-64-v3 everywhere. ttf_fusion hands it on.
set(TTF_EIGEN_ALIGNMENT EIGEN_MAX_ALIGN_BYTES=32 EIGEN_MAX_STATIC_ALIGN_BYTES=32)
target_compile_definitions(ttf_options INTERFACE ${TTF_EIGEN_ALIGNMENT})
if(TTF_SANITIZE)
  # Three pointer checks are off. AddressSanitizer sees the access itself. They cost half of Eigen's compile time.
  # Sanitizers keep g++ 12 from inlining; it then reports uninitialised reads inside the standard library.
  target_compile_options(ttf_options INTERFACE
    -fsanitize=${TTF_SANITIZE} -fno-sanitize=null,object-size,pointer-overflow
    -fno-sanitize-recover=all -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(ttf_options INTERFACE -fsanitize=${TTF_SANITIZE})
endif()
if(TTF_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "TTF_FUZZ needs clang++ (libFuzzer); use the preset asan-ubsan")
  endif()
  # Coverage of our own code guides the fuzzers. Only the fuzz targets link libFuzzer itself (tests/fuzz).
  target_compile_options(ttf_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# g++ collects garbage as if memory were scarce, which costs a twelfth of the build.
target_compile_options(ttf_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)

# Headers that nearly every source includes are compiled once for the modules and once for the tests. A source still includes
# every header it needs: clang-tidy (tools/tidy.sh) and builds without compiled headers (debug) find a missing one.
set(TTF_COMMON_HEADERS
  <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory> <numeric>
  <optional> <set> <span> <sstream> <string> <string_view> <utility> <variant> <vector> <fmt/format.h> <Eigen/Core>)
# ttf_common_headers(<name> [OPTIONS <options...>] [HEADERS <more...>] [DEPS <targets...>]): compiled headers to reuse.
function(ttf_common_headers name)
  cmake_parse_arguments(COMMON "" "" "OPTIONS;HEADERS;DEPS" ${ARGN})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.cc CONTENT "// The headers alone.\n")
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/${name}.cc)
  target_link_libraries(${name} PRIVATE ttf_options fmt::fmt Eigen3::Eigen ${COMMON_DEPS})
  target_compile_options(${name} PRIVATE ${COMMON_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${TTF_COMMON_HEADERS} ${COMMON_HEADERS})
endfunction()
# WARM code reads files and checks them. COLD code reads flags, and writes pages, pictures and JSON. A release optimises both less.
# A build with sanitizers optimises COLD code not at all, and WARM code as usual, whose tests run long. Both share compiled headers
# with those of JSON. With those of flags (CLI11) as well, the unit of `faults` took 11 s of a processor instead of 6.
set(TTF_COLD_OPTIONS $<$<CONFIG:Release>:-O1>)
if(TTF_SANITIZE)
  set(TTF_COLD_OPTIONS -O0)
endif()
if(TTF_BUILD_PROGRAM)
  ttf_common_headers(ttf_module_headers)
  ttf_common_headers(ttf_cold_headers OPTIONS ${TTF_COLD_OPTIONS} HEADERS <nlohmann/json.hpp> DEPS nlohmann_json::nlohmann_json)
endif()

# ttf_module(<name> SOURCES <files...> [DEPS <targets...>] [HOT | WARM | COLD]): the static library of a folder. A drive spends most of its
# time in HOT modules. They are optimised further, without compiled headers, and take 3 to 5 % fewer instructions.
function(ttf_module name)
  cmake_parse_arguments(MODULE "HOT;WARM;COLD" "" "SOURCES;DEPS" ${ARGN})
  if(MODULE_SOURCES)
    add_library(${name} STATIC ${MODULE_SOURCES})
    # The export needs no flags: $<BUILD_INTERFACE:...>.
    target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:ttf_options> PUBLIC ${MODULE_DEPS})
    target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
    target_compile_features(${name} PUBLIC cxx_std_20)
    if(MODULE_HOT AND CMAKE_BUILD_TYPE STREQUAL "Release")
      target_compile_options(${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-O3>)
    elseif(TARGET ttf_module_headers)
      # The compiled headers have fmt's definitions, so a module without fmt has them, too.
      target_compile_definitions(${name} PRIVATE $<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>)
      if(MODULE_COLD OR (MODULE_WARM AND NOT TTF_SANITIZE))
        target_compile_options(${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:${TTF_COLD_OPTIONS}>)
        target_precompile_headers(${name} REUSE_FROM ttf_cold_headers)
      else()
        target_precompile_headers(${name} REUSE_FROM ttf_module_headers)
      endif()
    endif()
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ${MODULE_DEPS})
    target_include_directories(${name} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  endif()
  string(REGEX REPLACE "^ttf_" "" module ${name})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${module})   # installed, ttfusion::<module>
endfunction()

if(TTF_BUILD_TESTS)
  find_package(GTest REQUIRED)
  # Tests' own code is not optimised, which builds faster; the modules that it calls are. Tests of arithmetic (tests/fusion) are an
  # exception: the linker may take a template of Eigen from them.
  # Sanitizers do not search it for undefined behaviour, which takes a third of its compile time. Programs link this after
  # ttf_options: the last option counts.
  add_library(ttf_test_options INTERFACE)
  if(TTF_SANITIZE MATCHES "undefined")
    target_compile_options(ttf_test_options INTERFACE -fno-sanitize=undefined)
  endif()
  ttf_common_headers(ttf_test_headers
    OPTIONS -O0 HEADERS <gtest/gtest.h> <gmock/gmock.h> DEPS GTest::gmock ttf_test_options)
  ttf_common_headers(ttf_arithmetic_test_headers
    OPTIONS -O1 HEADERS <gtest/gtest.h> <gmock/gmock.h> DEPS GTest::gmock ttf_test_options)
endif()

# ttf_as_test(<name>): compiles a program as a test is compiled, with the tests' headers.
function(ttf_as_test name)
  target_link_libraries(${name} PRIVATE ttf_options ttf_test_options)
  target_compile_definitions(${name} PRIVATE GTEST_HAS_PTHREAD=1)
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "/tests/fusion")
    target_compile_options(${name} PRIVATE -O1)
    target_precompile_headers(${name} REUSE_FROM ttf_arithmetic_test_headers)
  else()
    target_compile_options(${name} PRIVATE -O0)
    target_precompile_headers(${name} REUSE_FROM ttf_test_headers)
  endif()
endfunction()

# ttf_link_modules_first(<name> <targets...>): names the modules of these targets, and those below them, before the program's own code.
# The linker keeps the first of several equal templates. Those of the modules are optimised, those of tests are not: with them first,
# tests that call the standard library's templates in modules run up to four times as fast.
function(ttf_modules_below out)
  set(modules)
  set(open ${ARGN})
  while(open)
    list(POP_FRONT open target)
    if(NOT TARGET "${target}" OR target IN_LIST modules)
      continue()
    endif()
    get_target_property(type ${target} TYPE)
    get_target_property(below ${target} INTERFACE_LINK_LIBRARIES)
    if(target MATCHES "^ttf_" AND type STREQUAL "STATIC_LIBRARY")
      list(APPEND modules ${target})
    endif()
    if(below)
      list(TRANSFORM below REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1")
      list(APPEND open ${below})
    endif()
  endwhile()
  set(${out} ${modules} PARENT_SCOPE)
endfunction()
function(ttf_link_modules_first name)
  ttf_modules_below(modules ${ARGN})
  list(TRANSFORM modules REPLACE "(.+)" "$<TARGET_FILE:\\1>")
  if(modules)
    target_link_options(${name} PRIVATE LINKER:--whole-archive ${modules} LINKER:--no-whole-archive)
  endif()
endfunction()

# Tests that take longest to build or to run are labelled slow: .ci/run has them, tools/test.sh has not. ttf_slow(<targets...>)
# excludes their programs from the default build; the fixture slow_tests builds them. A build with sanitizers excludes none.
if(TTF_BUILD_TESTS AND NOT TTF_SANITIZE)
  add_custom_target(slow_tests)
  add_test(NAME build_slow_tests COMMAND ${CMAKE_COMMAND} --build ${CMAKE_BINARY_DIR} --target slow_tests)
  set_tests_properties(build_slow_tests PROPERTIES LABELS slow FIXTURES_SETUP slow_tests COST 1000)
endif()
function(ttf_slow)
  if(NOT TTF_SANITIZE)
    set_target_properties(${ARGN} PROPERTIES EXCLUDE_FROM_ALL ON)
    add_dependencies(slow_tests ${ARGN})
  endif()
endfunction()

# ttf_by_wall_clock(<tests...>): tests that are about the machine's own time. They run alone, after the slow ones.
function(ttf_by_wall_clock)
  ttf_slow(${ARGN})
  set_tests_properties(${ARGN} PROPERTIES RUN_SERIAL ON LABELS realtime)
  if(NOT TTF_SANITIZE)
    set_tests_properties(${ARGN} PROPERTIES FIXTURES_REQUIRED slow_tests)
  endif()
endfunction()

# ttf_test(<name> SOURCES <files...> [DEPS <targets...>] [SLOW | SLOW_TESTS <patterns...>]
# [UNSANITIZED | UNSANITIZED_TESTS <patterns...>] [COST <n>]): one GoogleTest program and its ctest entry. SLOW: see ttf_slow().
# SLOW_TESTS: tests of the program that have a second entry, <name>_slow, labelled slow.
# Sanitizers run where they can find something: bytes, buffers, lifetimes. They skip statistics over thousands of runs, whole
# drives that other tests run, and headers full of arithmetic, which take the compiler minutes. With sanitizers an UNSANITIZED
# program is not built, and UNSANITIZED_TESTS do not run.
function(ttf_test name)
  cmake_parse_arguments(TEST "UNSANITIZED;SLOW" "COST" "SOURCES;DEPS;SLOW_TESTS;UNSANITIZED_TESTS" ${ARGN})
  if(TEST_UNSANITIZED AND TTF_SANITIZE)
    return()
  endif()
  add_executable(${name} ${TEST_SOURCES})
  target_link_libraries(${name} PRIVATE ${TEST_DEPS} ttf_options GTest::gmock GTest::gtest_main)
  ttf_link_modules_first(${name} ${TEST_DEPS})
  target_compile_definitions(${name} PRIVATE TTF_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  ttf_as_test(${name})
  set(elsewhere ${TEST_SLOW_TESTS})
  if(TTF_SANITIZE)
    set(elsewhere ${TEST_UNSANITIZED_TESTS})
  endif()
  list(JOIN elsewhere ":" patterns)
  set(filter)
  if(patterns)
    set(filter --gtest_filter=-${patterns})
  endif()
  add_test(NAME ${name} COMMAND ${name} ${filter} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  if(patterns AND NOT TTF_SANITIZE)
    add_test(NAME ${name}_slow COMMAND ${name} --gtest_filter=${patterns} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${name}_slow PROPERTIES LABELS slow)
  endif()
  if(TEST_SLOW)
    ttf_slow(${name})
    set_tests_properties(${name} PROPERTIES LABELS slow)
    if(NOT TTF_SANITIZE)
      set_tests_properties(${name} PROPERTIES FIXTURES_REQUIRED slow_tests)
    endif()
  endif()
  if(TEST_COST)
    set_tests_properties(${name} PROPERTIES COST ${TEST_COST})   # about its seconds: the longest begin first
  endif()
endfunction()
