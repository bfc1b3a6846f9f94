# SPDX-License-Identifier: Apache-2.0
# Test programs and their levels. Each test has one ctest label:
#   release, asan                     ./test: the tree without a sanitizer, the tree with AddressSanitizer
#   full, asan_full, tsan             ./test --full, beside those above
#   soak                              ./test --soak
#   tsan_full                         no level: tests that the tree with ThreadSanitizer could build
# The target default_tests builds the programs of release, asan and tsan, and all_tests every program of this tree.
add_custom_target(default_tests)
add_custom_target(all_tests)
add_dependencies(all_tests default_tests)

if(PHALANX_SANITIZE MATCHES "address")
  set(PHALANX_TREE asan)
elseif(PHALANX_SANITIZE MATCHES "thread")
  set(PHALANX_TREE tsan)
else()
  set(PHALANX_TREE release)
endif()
if(PHALANX_TREE STREQUAL "release")
  set(PHALANX_TEST_PREFIX "")
  set(PHALANX_FULL_LABEL full)
else()
  set(PHALANX_TEST_PREFIX ${PHALANX_TREE}.)
  set(PHALANX_FULL_LABEL ${PHALANX_TREE}_full)
endif()

# What ./test -R and ./test --affected choose programs by: each program's sources and level, and what tests that are no GoogleTest suites need.
file(WRITE ${CMAKE_BINARY_DIR}/test_programs.txt "")
file(WRITE ${CMAKE_BINARY_DIR}/other_tests.txt "")
add_custom_target(no_program)
function(phalanx_test_needs target)
  foreach(test ${ARGN})
    file(APPEND ${CMAKE_BINARY_DIR}/other_tests.txt "${test} ${target}\n")
  endforeach()
endfunction()

# phalanx_test_level(LEVEL [TARGETS target ...] [TESTS name ...])
# Puts programs and tests that add_test() made into a level: `default` or `full`.
function(phalanx_test_level level)
  cmake_parse_arguments(ARG "" "" "TARGETS;TESTS" ${ARGN})
  if(level STREQUAL "default")
    set(label ${PHALANX_TREE})
    set(all default_tests)
  else()
    set(label ${PHALANX_FULL_LABEL})
    set(all all_tests)
  endif()
  if(ARG_TARGETS)
    add_dependencies(${all} ${ARG_TARGETS})
  endif()
  if(ARG_TESTS)
    set_tests_properties(${ARG_TESTS} PROPERTIES LABELS ${label})
  endif()
endfunction()

# phalanx_test(NAME SOURCES file ... [MODULES module ...] [LIBRARIES external ...]
#              [IN_ASAN] [IN_TSAN] [FULL_LEVEL] [COUNTS_ALLOCATIONS] [HELD_CLOCK]
#              [FULL filter ...] [FULL_IN_ASAN filter ...] [FULL_SOURCES_IN_ASAN file ...] [EACH_CASE suite ...] [ALONE suite ...] [SHARDS suite=count ...] [USES_PROGRAM] [DEFINITIONS ...])
# A GoogleTest program. ctest sees one test for each suite, named as the suite; a failure names the case.
#   IN_ASAN, IN_TSAN      ./test runs it in that sanitized tree; elsewhere in such a tree it belongs to --full
#   FULL_LEVEL            all of it belongs to --full
#   COUNTS_ALLOCATIONS    links tests/support/count_allocations.cpp, with malloc and its like wrapped
#   HELD_CLOCK            runs under a held clock, see tests/support/held_clock/held_clock.h
#   FULL                  GoogleTest filters: cases that only --full runs
#   FULL_IN_ASAN          the same, of the tree with AddressSanitizer
#   FULL_SOURCES_IN_ASAN  further sources; in the tree with AddressSanitizer they are a program of their own, NAME_full, of --full. A file that both
#                         need is named in both lists
#   EACH_CASE             suites of which each case has a process to itself, since it changes what belongs to the process
#   ALONE                 suites beside which nothing else runs
#   SHARDS                suites that take long: split into so many processes
#   USES_PROGRAM          starts the program itself, whose path is PHALANX_PROGRAM
# Suites whose name begins with Soak have the label soak.
function(phalanx_test name)
  cmake_parse_arguments(ARG "IN_ASAN;IN_TSAN;FULL_LEVEL;COUNTS_ALLOCATIONS;HELD_CLOCK;USES_PROGRAM" ""
                        "SOURCES;MODULES;LIBRARIES;FULL;FULL_IN_ASAN;FULL_SOURCES_IN_ASAN;EACH_CASE;ALONE;SHARDS;DEFINITIONS" ${ARGN})
  if(ARG_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "phalanx_test(${name}): ${ARG_UNPARSED_ARGUMENTS}?")
  endif()
  if(ARG_FULL_SOURCES_IN_ASAN AND (ARG_COUNTS_ALLOCATIONS OR ARG_HELD_CLOCK OR ARG_USES_PROGRAM OR ARG_DEFINITIONS))
    message(FATAL_ERROR "phalanx_test(${name}): FULL_SOURCES_IN_ASAN passes on modules and libraries only")
  endif()
  if(ARG_FULL_SOURCES_IN_ASAN AND PHALANX_TREE STREQUAL "asan")
    phalanx_test(${name}_full FULL_LEVEL SOURCES ${ARG_FULL_SOURCES_IN_ASAN} MODULES ${ARG_MODULES} LIBRARIES ${ARG_LIBRARIES})
  else()
    list(APPEND ARG_SOURCES ${ARG_FULL_SOURCES_IN_ASAN})
    list(REMOVE_DUPLICATES ARG_SOURCES)
  endif()
  if("link" IN_LIST ARG_MODULES OR "web" IN_LIST ARG_MODULES)
    list(APPEND ARG_MODULES asio) # their functions of it that are no templates
  endif()
  if("figures" IN_LIST ARG_MODULES OR "report" IN_LIST ARG_MODULES)
    list(APPEND ARG_MODULES charts)
  endif()
  list(TRANSFORM ARG_MODULES PREPEND phalanx_ OUTPUT_VARIABLE modules)
  set(level default)
  set(options phalanx_test_options)
  if(ARG_FULL_LEVEL OR (PHALANX_TREE STREQUAL "asan" AND NOT ARG_IN_ASAN) OR (PHALANX_TREE STREQUAL "tsan" AND NOT ARG_IN_TSAN))
    set(level full)
    if(PHALANX_SANITIZE)
      set(options phalanx_full_test_options)
    endif()
  endif()
  add_executable(${name} ${ARG_SOURCES})
  # The product's objects stand first on the linker's line: of an inline function the first copy counts, the one as shipped.
  target_link_libraries(${name} PRIVATE phalanx_options ${options} ${modules} ${ARG_LIBRARIES} GTest::gmock GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE PHALANX_SOURCE_DIR="${PROJECT_SOURCE_DIR}" ${ARG_DEFINITIONS})
  set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 8) # with 12, those of the steps take 0.99 GB
  if(options STREQUAL "phalanx_test_options")
    target_precompile_headers(${name} REUSE_FROM phalanx_precompiled_tests)
  endif()
  if(ARG_COUNTS_ALLOCATIONS)
    set(counter ${PROJECT_SOURCE_DIR}/tests/support/count_allocations.cpp)
    target_sources(${name} PRIVATE ${counter})
    set_source_files_properties(${counter} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON) # it replaces malloc and free
    target_link_options(${name} PRIVATE -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=aligned_alloc,--wrap=posix_memalign)
  endif()
  if(PHALANX_TREE STREQUAL "tsan" AND grasp IN_LIST ARG_MODULES)
    target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support/one_tbb_thread.cpp)
  endif()
  if(ARG_HELD_CLOCK)
    target_link_libraries(${name} PRIVATE phalanx_hold_this_process)
  endif()
  if(ARG_USES_PROGRAM)
    target_compile_definitions(${name} PRIVATE PHALANX_PROGRAM="$<TARGET_FILE:phalanx>")
    add_dependencies(${name} phalanx)
  endif()

  phalanx_test_level(${level} TARGETS ${name})
  if(level STREQUAL "default")
    set(label ${PHALANX_TREE})
  else()
    set(label ${PHALANX_FULL_LABEL})
  endif()

  if(PHALANX_TREE STREQUAL "asan")
    list(APPEND ARG_FULL ${ARG_FULL_IN_ASAN})
  endif()
  foreach(source ${ARG_SOURCES})
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE)
    file(APPEND ${CMAKE_BINARY_DIR}/test_programs.txt "${source} ${name} ${level}\n")
  endforeach()

  set(tests ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
  foreach(argument FULL EACH_CASE ALONE SHARDS)
    list(JOIN ARG_${argument} ":" ${argument})
  endforeach()
  add_custom_command(
    TARGET ${name}
    POST_BUILD
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${name}> -DOUT=${tests} -DPREFIX=${PHALANX_TEST_PREFIX} -DLABEL=${label}
            -DFULL_LABEL=${PHALANX_FULL_LABEL} -DFULL=${FULL} -DEACH_CASE=${EACH_CASE} -DALONE=${ALONE} -DSHARDS=${SHARDS}
            -P ${PROJECT_SOURCE_DIR}/cmake/list_suites.cmake
    BYPRODUCTS ${tests}
    VERBATIM)
  # A program that is not built has no tests here.
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake "if(EXISTS \"${tests}\")\n  include(\"${tests}\")\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake)
endfunction()

# Test code is compiled cheaply. The modules under test are the program's own objects, optimised as shipped. What only --full runs in a
# sanitized tree compares with brute force for minutes: there, optimising costs less than it saves.
add_library(phalanx_test_options INTERFACE)
add_library(phalanx_full_test_options INTERFACE)
target_compile_options(phalanx_full_test_options INTERFACE -O1)
if(PHALANX_SANITIZE)
  target_compile_options(phalanx_test_options INTERFACE -O0)
elseif(CMAKE_BUILD_TYPE STREQUAL "Release")
  target_compile_options(phalanx_test_options INTERFACE -O1)
endif()
