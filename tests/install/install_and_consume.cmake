# SPDX-License-Identifier: Apache-2.0
# Installs BUILD_DIR into a fresh prefix under WORK_DIR, moves that prefix (a package must not remember where it was installed), builds
# the programs in CONSUMER_DIR, README's program and the example driver OWN_DEVICE_DIR against it and runs what came out. Also asks for what
# the package does not have.
function(must)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT result EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "failed (${result}): ${command}")
  endif()
  set(output "${output}" PARENT_SCOPE)
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

# The installed libraries need neither packages that only the program uses, nor header-only libraries.
file(GLOB_RECURSE exported ${WORK_DIR}/prefix/phalanx*.cmake)
foreach(file ${exported})
  file(READ ${file} text)
  if(text MATCHES "Boost|embree|PNG::|nlohmann")
    message(FATAL_ERROR "${file} asks for ${CMAKE_MATCH_0}")
  endif()
endforeach()

# Builds SOURCE with the library phalanx::COMPONENT, with the further options, and runs it. Its output is in `output`.
function(consume component source)
  set(build ${WORK_DIR}/${component}_consumer)
  must(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${build} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
       -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCOMPONENT=${component} -DSOURCE=${source} ${ARGN})
  must(${CMAKE_COMMAND} --build ${build})
  must(${CMAKE_COMMAND} -E env PHALANX_DATA=${WORK_DIR}/prefix/share/phalanx ${build}/consumer)
  set(output "${output}" PARENT_SCOPE)
endfunction()

# README's program needs Eigen and no other package.
file(READ ${WORK_DIR}/prefix/share/doc/phalanx/README.md readme)
if(NOT readme MATCHES "```cpp\n([^`]+)```")
  message(FATAL_ERROR "README.md has no program in C++")
endif()
file(WRITE ${WORK_DIR}/readme.cpp "${CMAKE_MATCH_1}")
set(without_station "") # without the packages of phalanx::station
foreach(package tomlplusplus fmt Threads)
  list(APPEND without_station -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
set(without_import -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON -DCMAKE_DISABLE_FIND_PACKAGE_meshoptimizer=ON)
consume(phalanx ${WORK_DIR}/readme.cpp ${without_import} ${without_station})
if(NOT output MATCHES "^-0[.][1-9][0-9]* Nm\n$") # the table pushes the finger open
  message(FATAL_ERROR "README's program printed: ${output}")
endif()
consume(import import_consumer.cpp ${without_station})
consume(station station_consumer.cpp)

# Configures a consumer of phalanx::COMPONENT with the further options. CMake must refuse it and state `reason`.
function(refuse component reason)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/refused_${component} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
            -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCOMPONENT=${component} -DSOURCE=import_consumer.cpp ${ARGN}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " stated "${output}") # CMake breaks lines
  string(FIND "${stated}" "${reason}" place)
  if(result EQUAL 0 OR place EQUAL -1)
    message(FATAL_ERROR "${component} with \"${ARGN}\": expected a refusal that states \"${reason}\", got ${result}:\n${output}")
  endif()
endfunction()

refuse(physics "there is no component physics; the components are phalanx, import, station")
refuse(phalanx "phalanx::phalanx needs the package Eigen3 3.4, which was not found" -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)

must(${CMAKE_COMMAND} -S ${OWN_DEVICE_DIR} -B ${WORK_DIR}/own_device -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
     -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
must(${CMAKE_COMMAND} --build ${WORK_DIR}/own_device)
# A session of 1 s, four times slower: it must not fail for a busy machine.
must(${CMAKE_COMMAND} -E env PHALANX_DATA=${WORK_DIR}/prefix/share/phalanx ${WORK_DIR}/own_device/own_device 1 4)
