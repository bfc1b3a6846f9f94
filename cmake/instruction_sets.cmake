# SPDX-License-Identifier: Apache-2.0
# phalanx_instruction_sets(FOLDER)
# The contact search is compiled once for each instruction set and chosen at run time; nothing else is compiled for more than the
# processor's baseline. Square roots need no errno and comparisons no trap: neither changes a result.
function(phalanx_instruction_sets folder)
  set(common -fno-math-errno -fno-trapping-math -Wno-psabi)
  set(avx2 "")
  set(avx512 "")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(avx2 -mavx2)
    set(avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mprefer-vector-width=512)
  endif()
  # Their own flags: no precompiled header fits them.
  set_source_files_properties(${folder}/search_portable.cpp ${folder}/search_avx2.cpp ${folder}/search_avx512.cpp
                              PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  set_source_files_properties(${folder}/search_portable.cpp PROPERTIES COMPILE_OPTIONS "${common}")
  set_source_files_properties(${folder}/search_avx2.cpp PROPERTIES COMPILE_OPTIONS "${common};${avx2}")
  set_source_files_properties(${folder}/search_avx512.cpp PROPERTIES COMPILE_OPTIONS "${common};${avx512}")
endfunction()
