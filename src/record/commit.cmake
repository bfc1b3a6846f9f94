# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# Writes HEADER with the commit of SOURCE_DIR, and "-dirty" if tracked files differ from it; "unknown" outside git. In an archive of git,
# cmake/commit.txt has the nearest tag, if there is one, and the commit.
# If nothing changed, it leaves the file unchanged, so that nothing is compiled again.
set(commit "")
file(STRINGS ${SOURCE_DIR}/cmake/commit.txt archived REGEX ".")
if(NOT archived MATCHES "Format:")
  list(GET archived 0 commit) # without a tag the only line
  list(LENGTH archived lines)
  if(lines EQUAL 1)
    string(SUBSTRING ${commit} 0 12 commit)
  endif()
endif()
find_program(GIT git)
if(GIT AND NOT commit)
  execute_process(
    COMMAND ${GIT} -C ${SOURCE_DIR} describe --always --dirty --tags --abbrev=12
    OUTPUT_VARIABLE commit
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT commit)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "// Written by src/record/commit.cmake.\n#pragma once\n#define PHALANX_COMMIT \"@commit@\"\n" @ONLY)
