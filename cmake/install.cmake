# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where: program, page, headers, libraries, assets, scenes, studies, documents, the link's reference in C for
# firmware, and the package that find_package(phalanx) reads.
# The two libraries install themselves into the export set, see phalanx_library() in modules.cmake.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/phalanx)
install(TARGETS phalanx RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY include/phalanx DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY assets scenes studies DESTINATION ${CMAKE_INSTALL_DATADIR}/phalanx)
# The page is built by `./run` and `./test`, not by CMake.
install(CODE "if(NOT EXISTS \"${PROJECT_SOURCE_DIR}/web/dist/index.html\")
  message(WARNING \"web/dist: the page has not been built, so the installed program has none; build it with ./run, then install again\")
endif()")
install(DIRECTORY web/dist/ DESTINATION ${CMAKE_INSTALL_DATADIR}/phalanx/web OPTIONAL PATTERN .sources EXCLUDE)
install(FILES src/device/link/phalanx_link.c DESTINATION ${CMAKE_INSTALL_DATADIR}/phalanx/link)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs)
install(FILES README.md CHANGELOG.md LICENSE NOTICE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT phalanxTargets NAMESPACE phalanx:: DESTINATION ${package_dir})

configure_package_config_file(cmake/phalanxConfig.cmake.in ${CMAKE_BINARY_DIR}/phalanxConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/phalanxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/phalanxConfig.cmake ${CMAKE_BINARY_DIR}/phalanxConfigVersion.cmake DESTINATION ${package_dir})
