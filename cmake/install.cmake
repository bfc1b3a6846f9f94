# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where: program, headers, libraries, assets, scenes, studies and the package that find_package(phalanx) reads.
# The two libraries install themselves into the export set, see phalanx_library() in modules.cmake.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/phalanx)
install(TARGETS phalanx RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY include/phalanx DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(DIRECTORY assets scenes studies DESTINATION ${CMAKE_INSTALL_DATADIR}/phalanx)
install(FILES LICENSE NOTICE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT phalanxTargets NAMESPACE phalanx:: DESTINATION ${package_dir})

configure_package_config_file(cmake/phalanxConfig.cmake.in ${CMAKE_BINARY_DIR}/phalanxConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/phalanxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/phalanxConfig.cmake ${CMAKE_BINARY_DIR}/phalanxConfigVersion.cmake DESTINATION ${package_dir})
