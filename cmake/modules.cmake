# SPDX-License-Identifier: Apache-2.0
# phalanx_module(NAME [COLD | HOT] SOURCES ... [LIBRARIES external ...] [HEADERS external ...] [PRECOMPILED header])
# One folder of src/ as an object library `phalanx_NAME`, so that its tests link it and what it uses and nothing else.
# LIBRARIES must be linked wherever the module is; HEADERS are header-only libraries, which the module alone includes.
# COLD is what no tick and no simulation spends its time in, see phalanx_cold_options in compile_options.cmake. HOT is what a sanitized tree
# spends its time in, see phalanx_hot_options.
# PRECOMPILED is a header of its own to compile first, instead of the one that the other modules share.
function(phalanx_module name)
  cmake_parse_arguments(ARG "COLD;HOT" "PRECOMPILED" "SOURCES;LIBRARIES;HEADERS" ${ARGN})
  add_library(phalanx_${name} OBJECT ${ARG_SOURCES})
  target_include_directories(phalanx_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(phalanx_${name} PUBLIC Eigen3::Eigen PRIVATE phalanx_options ${ARG_LIBRARIES} ${ARG_HEADERS})
  if(ARG_COLD)
    target_link_libraries(phalanx_${name} PRIVATE phalanx_cold_options)
  endif()
  if(ARG_HOT)
    target_link_libraries(phalanx_${name} PRIVATE phalanx_hot_options)
  endif()
  if(ARG_PRECOMPILED)
    target_precompile_headers(phalanx_${name} PRIVATE ${ARG_PRECOMPILED})
  elseif(ARG_COLD AND PHALANX_SANITIZE)
    target_precompile_headers(phalanx_${name} REUSE_FROM phalanx_precompiled_cold)
  else()
    target_precompile_headers(phalanx_${name} REUSE_FROM phalanx_precompiled_product)
  endif()
  set_target_properties(phalanx_${name} PROPERTIES PHALANX_LIBRARIES "${ARG_LIBRARIES}")
endfunction()

# phalanx_library(TARGET OUTPUT file EXPORT name MODULES module ... [USES TARGET ...])
# The installed static library phalanx::name (lib<file>.a) out of the modules' objects and the libraries that they need. It is the component
# `name` of the package, and has an export set of its own.
function(phalanx_library target)
  cmake_parse_arguments(ARG "" "OUTPUT;EXPORT" "MODULES;USES" ${ARGN})
  add_library(${target} STATIC)
  add_library(phalanx::${ARG_EXPORT} ALIAS ${target})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${ARG_OUTPUT} EXPORT_NAME ${ARG_EXPORT} LINKER_LANGUAGE CXX)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set(libraries "")
  foreach(module ${ARG_MODULES})
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:phalanx_${module}>)
    get_target_property(of_module phalanx_${module} PHALANX_LIBRARIES)
    list(APPEND libraries ${of_module})
  endforeach()
  list(REMOVE_DUPLICATES libraries)
  if("phalanx_wire" IN_LIST libraries) # the compiled schema is no library of its own for a user
    list(REMOVE_ITEM libraries phalanx_wire)
    list(APPEND libraries protobuf::libprotobuf)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:phalanx_wire>)
  endif()
  target_link_libraries(${target} PUBLIC ${ARG_USES} Eigen3::Eigen PRIVATE ${libraries})
  install(TARGETS ${target} EXPORT phalanx_${ARG_EXPORT} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()
