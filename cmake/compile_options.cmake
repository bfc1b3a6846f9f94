# SPDX-License-Identifier: Apache-2.0
# Flags that every target of the project is compiled with.
add_library(phalanx_options INTERFACE)
target_compile_options(
  phalanx_options
  INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast>
            $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -Wdouble-promotion -Werror
            # Same samples, same bits at every optimisation level: no fused multiply-add behind our back.
            -ffp-contract=off)
if(PHALANX_SANITIZE)
  target_compile_options(phalanx_options INTERFACE -fsanitize=${PHALANX_SANITIZE} -fno-omit-frame-pointer
                                                   -fno-sanitize-recover=all)
  target_link_options(phalanx_options INTERFACE -fsanitize=${PHALANX_SANITIZE})
endif()
