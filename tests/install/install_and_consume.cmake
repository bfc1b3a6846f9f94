# SPDX-License-Identifier: Apache-2.0
# Installs BUILD_DIR into a fresh prefix under WORK_DIR, and moves that prefix: a package must not remember where it was installed. Compiles
# each installed header by itself. Builds the programs in CONSUMER_DIR, README's program and the installed examples against the prefix, and
# runs them. Also asks for what the package does not have.
cmake_minimum_required(VERSION 3.25)

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

# The headers are those of the lists, and each compiles by itself with nothing but the prefix and Eigen.
include(${CMAKE_CURRENT_LIST_DIR}/../../cmake/public_headers.cmake)
set(listed ${PHALANX_PUBLIC_HEADERS} ${PHALANX_IMPORT_PUBLIC_HEADERS} ${PHALANX_SIMULATION_PUBLIC_HEADERS}
           ${PHALANX_STATION_PUBLIC_HEADERS} ${PHALANX_RECORDING_PUBLIC_HEADERS} ${PHALANX_C_PUBLIC_HEADERS})
file(GLOB_RECURSE installed RELATIVE ${WORK_DIR}/prefix/include/phalanx ${WORK_DIR}/prefix/include/phalanx/*)
set(unlisted ${installed})
list(REMOVE_ITEM unlisted ${listed})
set(missing ${listed})
list(REMOVE_ITEM missing ${installed})
if(unlisted OR missing)
  message(FATAL_ERROR "include/phalanx has ${unlisted}, which cmake/public_headers.cmake does not list, and has not ${missing}")
endif()
list(TRANSFORM listed PREPEND phalanx/)
must(${CMAKE_CURRENT_LIST_DIR}/compile_headers ${CXX} ${WORK_DIR}/prefix/include ${listed})

# Bash can read the script, and it asks the program that was installed with it.
must(bash -c "PATH=${WORK_DIR}/prefix/bin
  . ${WORK_DIR}/prefix/share/bash-completion/completions/phalanx
  COMP_WORDS=(phalanx sim) COMP_CWORD=1
  _phalanx
  test \"\$COMPREPLY\" = simulate")

# Firmware takes the reference in C from the installed files alone.
must(${CC} -c -I${WORK_DIR}/prefix/include ${WORK_DIR}/prefix/share/phalanx/link/phalanx_link.c -o ${WORK_DIR}/phalanx_link.o)

# An Arduino library of the installed files.
must(bash ${WORK_DIR}/prefix/share/doc/phalanx/examples/arduino/make_library ${WORK_DIR}/arduino)
foreach(expected phalanx_link.c PhalanxLink.h phalanx/device/link/phalanx_link.h)
  if(NOT EXISTS ${WORK_DIR}/arduino/src/${expected})
    message(FATAL_ERROR "examples/arduino/make_library did not make src/${expected} of the installed files")
  endif()
endforeach()

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
  if(text MATCHES "Boost|embree|PNG::|nlohmann|${BUILD_DIR}|${WORK_DIR}")
    message(FATAL_ERROR "${file} asks for ${CMAKE_MATCH_0}")
  endif()
endforeach()

# Builds SOURCE with the library phalanx::COMPONENT, with the further options, and runs it. Its output is in `output`.
function(consume component source)
  string(MD5 options "${source} ${ARGN}")
  set(build ${WORK_DIR}/${component}_${options})
  must(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${build} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
       -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCOMPONENT=${component} -DSOURCE=${source} ${ARGN})
  must(${CMAKE_COMMAND} --build ${build})
  must(${CMAKE_COMMAND} -E env PHALANX_DATA_DIR=${WORK_DIR}/prefix/share/phalanx ${build}/consumer)
  set(output "${output}" PARENT_SCOPE)
endfunction()

# README's program needs Eigen and no other package.
file(READ ${WORK_DIR}/prefix/share/doc/phalanx/README.md readme)
if(NOT readme MATCHES "```cpp\n([^`]+)```")
  message(FATAL_ERROR "README.md has no program in C++")
endif()
file(WRITE ${WORK_DIR}/readme.cpp "${CMAKE_MATCH_1}")
function(without name)
  set(options "")
  foreach(package ${ARGN})
    list(APPEND options -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
  endforeach()
  set(${name} ${options} PARENT_SCOPE)
endfunction()
without(without_recording Protobuf OpenSSL ZLIB PkgConfig)
without(without_station Threads)
list(APPEND without_station ${without_recording})
without(without_simulation tomlplusplus fmt Qhull TBB)
list(APPEND without_simulation ${without_station})
without(without_import assimp meshoptimizer)
list(APPEND without_import ${without_simulation})
consume(phalanx ${WORK_DIR}/readme.cpp ${without_import})
if(NOT output MATCHES "^-0[.][1-9][0-9]* Nm\n$") # the table pushes the finger open
  message(FATAL_ERROR "README's program printed: ${output}")
endif()
consume(import import_consumer.cpp ${without_simulation})
consume(simulation simulation_consumer.cpp ${without_recording}) # TBB needs Threads
consume(station station_consumer.cpp ${without_recording})

# A program with other options than the library has the same forces, to the last bit: types are laid out alike, and the program does not
# replace code of the library. It is compiled without CMake, as docs/library.md states.
consume(phalanx force_hash.cpp)
set(plain "${output}")
set(wide "-O3")
file(STRINGS /proc/cpuinfo has_avx2 REGEX "^flags.* avx2 " LIMIT_COUNT 1)
if(has_avx2)
  set(wide "-O3 -mavx2")
endif()
foreach(options "${wide}" "-O1 -fsanitize=address" "${wide} -fsanitize=address")
  must(sh -c "${CXX} -std=c++20 ${options} ${CONSUMER_DIR}/force_hash.cpp -I${WORK_DIR}/prefix/include $(pkg-config --cflags eigen3) \
    -L${WORK_DIR}/prefix/lib -lphalanx_haptics -o ${WORK_DIR}/force_hash")
  must(${WORK_DIR}/force_hash)
  if(NOT output STREQUAL plain)
    message(FATAL_ERROR "force_hash.cpp with ${options} printed ${output}, and by find_package() ${plain}")
  endif()
endforeach()

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

refuse(physics "there is no component physics; the components are phalanx, import, simulation, station, recording")
refuse(phalanx "phalanx::phalanx needs the package Eigen3 3.4, which was not found" -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)

# The examples, as installed, each of them under 60 lines.
set(examples ${WORK_DIR}/prefix/share/doc/phalanx/examples)
file(GLOB_RECURSE sources ${examples}/0*.cpp)
foreach(source ${sources})
  file(STRINGS ${source} lines)
  list(LENGTH lines count)
  if(count GREATER_EQUAL 60)
    message(FATAL_ERROR "${source} has ${count} lines; an example has fewer than 60")
  endif()
endforeach()
must(${CMAKE_COMMAND} -S ${examples} -B ${WORK_DIR}/examples -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_C_COMPILER=${CC}
     -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_CXX_FLAGS=-Wall\ -Wextra\ -Werror)
must(${CMAKE_COMMAND} --build ${WORK_DIR}/examples)
set(arguments_own_device 1 4) # a session of 1 s, four times slower: it must not fail for a busy machine
set(arguments_recording ${WORK_DIR}/recordings)
foreach(name step_loop own_object own_force_law own_stabiliser own_device recording game_loop many_hands)
  must(${CMAKE_COMMAND} -E env PHALANX_DATA_DIR=${WORK_DIR}/prefix/share/phalanx ${WORK_DIR}/examples/${name} ${arguments_${name}})
endforeach()
