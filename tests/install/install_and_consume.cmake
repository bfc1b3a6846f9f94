# SPDX-License-Identifier: Apache-2.0
# Installs BUILD_DIR into a fresh prefix under WORK_DIR, moves that prefix (a package must not remember where it was installed), builds
# CONSUMER_DIR and the example driver OWN_DEVICE_DIR against it and runs what came out.
function(must)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "failed (${result}): ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
must(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/first)
file(RENAME ${WORK_DIR}/first ${WORK_DIR}/prefix)

foreach(expected bin/phalanx include/phalanx/step/haptic_step.h share/phalanx/assets share/phalanx/scenes share/phalanx/web/index.html
                 share/phalanx/link/phalanx_link.c share/doc/phalanx/README.md share/doc/phalanx/docs/device.md
                 share/doc/phalanx/docs/pictures/cockpit.png share/bash-completion/completions/phalanx
                 share/zsh/site-functions/_phalanx)
  if(NOT EXISTS ${WORK_DIR}/prefix/${expected})
    message(FATAL_ERROR "not installed: ${expected}")
  endif()
endforeach()

# The page's server belongs to the program: no installed library has it.
if(EXISTS ${WORK_DIR}/prefix/include/phalanx/serve)
  message(FATAL_ERROR "installed without a library: include/phalanx/serve")
endif()

# Bash can read the script, and it asks the program that was installed with it.
must(bash -c "PATH=${WORK_DIR}/prefix/bin
  . ${WORK_DIR}/prefix/share/bash-completion/completions/phalanx
  COMP_WORDS=(phalanx sim) COMP_CWORD=1
  _phalanx
  test \"\$COMPREPLY\" = simulate")

# Firmware takes the reference in C from the installed files alone.
must(${CC} -c -I${WORK_DIR}/prefix/include ${WORK_DIR}/prefix/share/phalanx/link/phalanx_link.c -o ${WORK_DIR}/phalanx_link.o)

# All that the page names is there.
file(READ ${WORK_DIR}/prefix/share/phalanx/web/index.html page)
string(REGEX MATCHALL "\\./assets/[^\"]+" named "${page}")
if(NOT named)
  message(FATAL_ERROR "the installed page names no script: ${page}")
endif()
foreach(asset ${named})
  if(NOT EXISTS ${WORK_DIR}/prefix/share/phalanx/web/${asset})
    message(FATAL_ERROR "not installed: share/phalanx/web/${asset}")
  endif()
endforeach()

must(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
     -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
must(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
must(${WORK_DIR}/build/consumer)
must(${CMAKE_COMMAND} -E env PHALANX_DATA=${WORK_DIR}/prefix/share/phalanx ${WORK_DIR}/build/station_consumer)

must(${CMAKE_COMMAND} -S ${OWN_DEVICE_DIR} -B ${WORK_DIR}/own_device -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
     -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
must(${CMAKE_COMMAND} --build ${WORK_DIR}/own_device)
# A session of 1 s, four times slower: it must not fail for a busy machine.
must(${CMAKE_COMMAND} -E env PHALANX_DATA=${WORK_DIR}/prefix/share/phalanx ${WORK_DIR}/own_device/own_device 1 4)
