# SPDX-License-Identifier: Apache-2.0
# Flags that every target of the project is compiled with.
add_library(phalanx_options INTERFACE)
target_compile_options(
  phalanx_options
  INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast>
            $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -Wdouble-promotion $<$<BOOL:${PHALANX_WARNINGS_ARE_ERRORS}>:-Werror>
            # Same samples, same bits at every optimisation level: no fused multiply-add behind our back.
            -ffp-contract=off)
# What no tick and no simulation spends its time in: files, pages, commands. Optimised little, since it takes the compiler a third less, and
# not at all with a sanitizer, where it takes half; a fuzzer spends its time there.
add_library(phalanx_cold_options INTERFACE)
if(PHALANX_SANITIZE AND NOT PHALANX_BUILD_FUZZERS)
  target_compile_options(phalanx_cold_options INTERFACE -O0)
elseif(CMAKE_BUILD_TYPE STREQUAL "Release")
  target_compile_options(phalanx_cold_options INTERFACE -O1)
endif()
# Meshes and contact search: with -O1 clang inlines nothing, and a sanitized test of the station spends 83 to 91 % of its time in building
# the teapot.
add_library(phalanx_hot_options INTERFACE)
if(PHALANX_SANITIZE)
  target_compile_options(phalanx_hot_options INTERFACE -O2)
  target_compile_options(phalanx_options INTERFACE -fsanitize=${PHALANX_SANITIZE} -fno-omit-frame-pointer
                                                   -fno-sanitize-recover=all)
  target_link_options(phalanx_options INTERFACE -fsanitize=${PHALANX_SANITIZE})
endif()
