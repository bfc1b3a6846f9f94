# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# Writes HEADER with the commit of SOURCE_DIR, and "-dirty" if tracked files differ from it; "unknown" outside git.
# If nothing changed, it leaves the file unchanged, so that nothing is compiled again.
set(commit "")
find_program(GIT git)
if(GIT)
  execute_process(
    COMMAND ${GIT} -C ${SOURCE_DIR} describe --always --dirty --tags --abbrev=12
    OUTPUT_VARIABLE commit
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT commit)
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "// Written by src/record/commit.cmake.\n#pragma once\n#define PHALANX_COMMIT \"@commit@\"\n" @ONLY)
