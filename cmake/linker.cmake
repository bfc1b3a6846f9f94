# SPDX-License-Identifier: Apache-2.0
# lld where it is installed: it links the test programs in a tenth of the time that GNU ld takes. Never needed.
find_program(PHALANX_LLD NAMES ld.lld-19 ld.lld)
if(PHALANX_LLD)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    add_link_options(--ld-path=${PHALANX_LLD})
  elseif(PHALANX_LLD MATCHES "/ld\\.lld$")
    add_link_options(-fuse-ld=lld)
  else()
    # GCC looks for a program of the name ld.lld and takes no path.
    file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/linker)
    file(CREATE_LINK ${PHALANX_LLD} ${CMAKE_BINARY_DIR}/linker/ld.lld SYMBOLIC)
    add_link_options(-fuse-ld=lld -B${CMAKE_BINARY_DIR}/linker)
  endif()
endif()
