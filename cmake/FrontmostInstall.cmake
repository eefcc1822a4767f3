# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` lays down: the library with its CMake and pkg-config descriptions, the program, the words.
include(CMakePackageConfigHelpers)

set(FRONTMOST_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/frontmost)
get_target_property(frontmost_kind frontmost TYPE)

# What a static library makes its users link: CMake packages, pkg-config modules and Debian packages, in this order.
# Header-only helpers (nlohmann-json, CLI11, fmt, tinygltf's header) never reach a consumer.
set(FRONTMOST_LINKED_CMAKE hwy Threads PNG ZLIB JPEG)
set(FRONTMOST_LINKED_PC libhwy libpng zlib libjpeg)
set(FRONTMOST_LINKED_DEB libhwy-dev libpng-dev zlib1g-dev libjpeg-dev)
if(FRONTMOST_THREADS STREQUAL tbb)
  list(APPEND FRONTMOST_LINKED_CMAKE TBB)
  list(APPEND FRONTMOST_LINKED_PC tbb)
  list(APPEND FRONTMOST_LINKED_DEB libtbb-dev)
endif()
if(FRONTMOST_OPENEXR)
  list(APPEND FRONTMOST_LINKED_CMAKE OpenEXR)
  list(APPEND FRONTMOST_LINKED_PC OpenEXR)
  list(APPEND FRONTMOST_LINKED_DEB libopenexr-dev)
endif()

install(TARGETS frontmost EXPORT frontmostTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT program NAMELINK_COMPONENT development)
install(DIRECTORY include/frontmost DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
  FILES_MATCHING PATTERN *.h)
install(FILES ${PROJECT_BINARY_DIR}/include/frontmost/version.h
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/frontmost COMPONENT development)
install(EXPORT frontmostTargets NAMESPACE frontmost:: DESTINATION ${FRONTMOST_CMAKE_DIR} COMPONENT development)

configure_package_config_file(cmake/frontmostConfig.cmake.in ${PROJECT_BINARY_DIR}/frontmostConfig.cmake
  INSTALL_DESTINATION ${FRONTMOST_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/frontmostConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/frontmostConfig.cmake ${PROJECT_BINARY_DIR}/frontmostConfigVersion.cmake
  DESTINATION ${FRONTMOST_CMAKE_DIR} COMPONENT development)

# A static library cannot be linked without what it links itself, so there these are plain requirements: consumers
# need no --static.
list(JOIN FRONTMOST_LINKED_PC " " linked_modules)
set(FRONTMOST_PC_REQUIRES glm)
if(frontmost_kind STREQUAL STATIC_LIBRARY)
  set(FRONTMOST_PC_REQUIRES "glm ${linked_modules}")
endif()
file(RELATIVE_PATH FRONTMOST_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/frontmost.pc.in ${PROJECT_BINARY_DIR}/frontmost.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/frontmost.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

if(TARGET frontmost_cli)
  install(TARGETS frontmost_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
