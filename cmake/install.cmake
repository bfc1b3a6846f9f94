# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where: program, its manual page and completion in shells, page, public headers, libraries, assets, scenes, studies,
# documents, examples, the link's reference in C for firmware, and the package that find_package(phalanx) reads.
# The libraries install themselves into their export sets, see phalanx_library() in modules.cmake.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/phalanx)
install(TARGETS phalanx RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# The program prints its manual page and the scripts, so that they fit it.
set(completion ${CMAKE_BINARY_DIR}/completion)
file(MAKE_DIRECTORY ${completion})
foreach(shell bash zsh)
  install(CODE "execute_process(COMMAND \"$<TARGET_FILE:phalanx>\" completion ${shell} OUTPUT_FILE \"${completion}/${shell}\" COMMAND_ERROR_IS_FATAL ANY)")
endforeach()
install(FILES ${completion}/bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME phalanx)
install(FILES ${completion}/zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions RENAME _phalanx)
install(CODE "execute_process(COMMAND \"$<TARGET_FILE:phalanx>\" man OUTPUT_FILE \"${CMAKE_BINARY_DIR}/phalanx.1\" COMMAND_ERROR_IS_FATAL ANY)")
install(FILES ${CMAKE_BINARY_DIR}/phalanx.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
include(${CMAKE_CURRENT_LIST_DIR}/public_headers.cmake)
foreach(header ${PHALANX_PUBLIC_HEADERS} ${PHALANX_IMPORT_PUBLIC_HEADERS} ${PHALANX_SIMULATION_PUBLIC_HEADERS}
        ${PHALANX_STATION_PUBLIC_HEADERS} ${PHALANX_RECORDING_PUBLIC_HEADERS})
  cmake_path(GET header PARENT_PATH folder)
  install(FILES include/phalanx/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/phalanx/${folder})
endforeach()
install(DIRECTORY assets scenes studies DESTINATION ${CMAKE_INSTALL_DATADIR}/phalanx)
# The page is built by `./run` and `./test`, not by CMake.
install(CODE "if(NOT EXISTS \"${PROJECT_SOURCE_DIR}/web/dist/index.html\")
  message(WARNING \"web/dist: the page has not been built, so the installed program has none; build it with ./run, then install again\")
endif()")
install(DIRECTORY web/dist/ DESTINATION ${CMAKE_INSTALL_DATADIR}/phalanx/web OPTIONAL PATTERN .sources EXCLUDE)
install(FILES src/device/link/phalanx_link.c DESTINATION ${CMAKE_INSTALL_DATADIR}/phalanx/link)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples USE_SOURCE_PERMISSIONS)
install(FILES README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md LICENSE NOTICE SECURITY.md THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
foreach(component phalanx import simulation station recording)
  install(EXPORT phalanx_${component} FILE phalanx_${component}Targets.cmake NAMESPACE phalanx:: DESTINATION ${package_dir})
endforeach()

configure_package_config_file(cmake/phalanxConfig.cmake.in ${CMAKE_BINARY_DIR}/phalanxConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/phalanxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/phalanxConfig.cmake ${CMAKE_BINARY_DIR}/phalanxConfigVersion.cmake DESTINATION ${package_dir})
