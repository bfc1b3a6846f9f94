# SPDX-License-Identifier: Apache-2.0
# phalanx_module(NAME SOURCES ... [LIBRARIES external ...])
# One folder of src/ as an object library `phalanx_NAME`, so that its tests link it and what it uses and nothing else.
function(phalanx_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(phalanx_${name} OBJECT ${ARG_SOURCES})
  target_include_directories(phalanx_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(phalanx_${name} PUBLIC Eigen3::Eigen PRIVATE phalanx_options ${ARG_LIBRARIES})
  set_target_properties(phalanx_${name} PROPERTIES PHALANX_LIBRARIES "${ARG_LIBRARIES}")
endfunction()

# phalanx_library(TARGET OUTPUT file EXPORT name MODULES module ... [USES TARGET ...])
# The installed static library phalanx::name (lib<file>.a) out of the modules' objects and the libraries that they need.
function(phalanx_library target)
  cmake_parse_arguments(ARG "" "OUTPUT;EXPORT" "MODULES;USES" ${ARGN})
  add_library(${target} STATIC)
  add_library(phalanx::${ARG_EXPORT} ALIAS ${target})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${ARG_OUTPUT} EXPORT_NAME ${ARG_EXPORT} LINKER_LANGUAGE CXX)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set(libraries "")
  foreach(module ${ARG_MODULES})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:phalanx_${module}>)
    get_target_property(of_module phalanx_${module} PHALANX_LIBRARIES)
    list(APPEND libraries ${of_module})
  endforeach()
  list(REMOVE_DUPLICATES libraries)
  target_link_libraries(${target} PUBLIC ${ARG_USES} Eigen3::Eigen PRIVATE ${libraries})
  install(TARGETS ${target} EXPORT phalanxTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

# phalanx_test(NAME SOURCES ... MODULES module ... [LIBRARIES external ...] [SOAK] [HELD_CLOCK])
# A GoogleTest program tests/.../NAME; every TEST of it becomes a ctest test, in a sanitized build with the prefix `asan.` or `tsan.`
# and the label of that name. With SOAK, those whose suite's name begins with `Soak` get the label `soak`, which ./test leaves out and
# ./test --soak (where the environment says PHALANX_SOAK=1) runs. With LONG_SANITIZED, all of them do so in a sanitized build, where they
# take a minute each. With HELD_CLOCK, the program runs under a held clock (tests/support/held_clock/held_clock.h).
function(phalanx_test name)
  cmake_parse_arguments(ARG "SOAK;LONG_SANITIZED;HELD_CLOCK" "" "SOURCES;MODULES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  set_source_files_properties(${PROJECT_SOURCE_DIR}/tests/support/count_allocations.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON) # it replaces malloc and free
  list(TRANSFORM ARG_MODULES PREPEND phalanx_ OUTPUT_VARIABLE modules)
  target_link_libraries(${name} PRIVATE phalanx_options ${modules} ${ARG_LIBRARIES} GTest::gmock GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE PHALANX_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  if(ARG_HELD_CLOCK)
    target_link_libraries(${name} PRIVATE phalanx_hold_this_process)
  endif()
  set(prefix "")
  set(label release)
  if(PHALANX_SANITIZE MATCHES "address")
    set(label asan)
  elseif(PHALANX_SANITIZE MATCHES "thread")
    set(label tsan)
  endif()
  if(PHALANX_SANITIZE)
    set(prefix TEST_PREFIX ${label}.)
  endif()
  if(PHALANX_SANITIZE AND ARG_LONG_SANITIZED)
    set(label soak)
  endif()
  set(ordinary "")
  if(ARG_SOAK)
    set(ordinary TEST_FILTER "-Soak*")
    gtest_discover_tests(
      ${name}
      ${prefix}
      TEST_FILTER "Soak*"
      TEST_LIST ${name}_SOAK
      NO_PRETTY_VALUES
      DISCOVERY_TIMEOUT 60
      PROPERTIES TIMEOUT 7200 LABELS soak)
  endif()
  gtest_discover_tests(${name} ${prefix} ${ordinary} NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600 LABELS ${label})
endfunction()
