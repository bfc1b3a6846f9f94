# SPDX-License-Identifier: Apache-2.0
# Precompiled headers: one for the modules of the product, one for the tests. Each is compiled once and used by all targets with the
# same flags. Without ccache only, which finds less in its cache with them. The presets `dev` and `tidy` have none, so that a file that
# does not include what it uses is noticed.
if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache")
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()

# phalanx_precompiled(NAME HEADER): the target phalanx_precompiled_NAME, from which others take it.
function(phalanx_precompiled name header)
  # The C source: CMake asks this target for the header in each language of those that take it, so C has one, that nothing needs.
  set(sources "")
  foreach(language c cpp)
    set(source ${CMAKE_BINARY_DIR}/precompiled/${name}.${language})
    file(CONFIGURE OUTPUT ${source} CONTENT "typedef int precompiled_${name}; // ${header}\n")
    list(APPEND sources ${source})
  endforeach()
  add_library(phalanx_precompiled_${name} OBJECT ${sources})
  target_link_libraries(phalanx_precompiled_${name} PRIVATE phalanx_options Eigen3::Eigen ${ARGN})
  target_precompile_headers(phalanx_precompiled_${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:${header}>
                                                                  $<$<COMPILE_LANGUAGE:C>:<stdint.h$<ANGLE-R>>)
endfunction()
