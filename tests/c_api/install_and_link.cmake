# SPDX-License-Identifier: Apache-2.0
# Installs the C interface alone into a fresh prefix, moves the prefix, and builds and runs a program in C with what pkg-config
# and what CMake's package state.
function(must)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGV}\n${output}${errors}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
foreach(component libphalanx libphalanx-dev)
  must(${CMAKE_COMMAND} --install ${BUILD_DIR} --component ${component} --prefix ${WORK_DIR}/first)
endforeach()
file(RENAME ${WORK_DIR}/first ${WORK_DIR}/prefix)
set(lib ${WORK_DIR}/prefix/${LIBDIR})
foreach(expected ${lib}/libphalanx.so ${lib}/libphalanx.so.0 ${lib}/pkgconfig/phalanx.pc ${lib}/cmake/phalanx/phalanx_cTargets.cmake
                 ${WORK_DIR}/prefix/include/phalanx/phalanx.h)
  if(NOT EXISTS ${expected})
    message(FATAL_ERROR "not installed: ${expected}")
  endif()
endforeach()
set(ENV{PKG_CONFIG_PATH} ${lib}/pkgconfig)
must(pkg-config --cflags --libs phalanx)
separate_arguments(flags UNIX_COMMAND "${output}")
must(${CC} -std=c99 -pedantic-errors -Werror ${SOURCE_DIR}/examples/c/step_loop.c ${flags} -o ${WORK_DIR}/step_loop)
set(ENV{LD_LIBRARY_PATH} ${lib})
must(${WORK_DIR}/step_loop press_teapot)
if(NOT output MATCHES "[0-9]+ steps, forces [0-9a-f]+")
  message(FATAL_ERROR "the program printed: ${output}")
endif()
# The library finds scenes and assets beside itself: the program is elsewhere.
file(COPY ${SOURCE_DIR}/scenes/press_teapot.toml DESTINATION ${WORK_DIR}/prefix/share/phalanx/scenes)
file(RENAME ${WORK_DIR}/prefix/share/phalanx/scenes/press_teapot.toml ${WORK_DIR}/prefix/share/phalanx/scenes/only_here.toml)
file(CREATE_LINK ${SOURCE_DIR}/assets ${WORK_DIR}/prefix/share/phalanx/assets SYMBOLIC)
must(${WORK_DIR}/step_loop only_here)
set(from_pkg_config "${output}")

# The package's files for CMake belong to all components, so that they are copied here.
file(COPY ${BUILD_DIR}/phalanxConfig.cmake ${BUILD_DIR}/phalanxConfigVersion.cmake DESTINATION ${lib}/cmake/phalanx)
must(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK_DIR}/consumer -G ${GENERATOR} -DCMAKE_C_COMPILER=${CC}
     -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DSOURCE=${SOURCE_DIR}/examples/c/step_loop.c)
must(${CMAKE_COMMAND} --build ${WORK_DIR}/consumer)
unset(ENV{LD_LIBRARY_PATH})
must(${WORK_DIR}/consumer/consumer only_here)
if(NOT output STREQUAL from_pkg_config)
  message(FATAL_ERROR "the program printed: ${output}")
endif()
