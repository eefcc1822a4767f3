# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` lays down: the library with its CMake and pkg-config descriptions, the program, the words.
include(CMakePackageConfigHelpers)

set(FRONTMOST_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/frontmost)
get_target_property(frontmost_kind frontmost TYPE)

# What a static library makes its users link: CMake packages, pkg-config modules and Debian packages, in this order.
# What the program alone uses (nlohmann-json, CLI11, fmt) never reaches a consumer.
set(FRONTMOST_LINKED_CMAKE hwy Threads)
set(FRONTMOST_LINKED_PC libhwy)
set(FRONTMOST_LINKED_DEB libhwy-dev)
if(FRONTMOST_PNG)
  list(APPEND FRONTMOST_LINKED_CMAKE PNG ZLIB)
  list(APPEND FRONTMOST_LINKED_PC libpng zlib)
  list(APPEND FRONTMOST_LINKED_DEB libpng-dev zlib1g-dev)
endif()
if(FRONTMOST_JPEG)
  list(APPEND FRONTMOST_LINKED_CMAKE JPEG)
  list(APPEND FRONTMOST_LINKED_PC libjpeg)
  list(APPEND FRONTMOST_LINKED_DEB libjpeg-dev)
endif()
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
if(FRONTMOST_ISAL)
  list(APPEND FRONTMOST_LINKED_CMAKE ISAL)
  list(APPEND FRONTMOST_LINKED_PC libisal)
  list(APPEND FRONTMOST_LINKED_DEB libisal-dev)
endif()
if(FRONTMOST_WEBP)
  list(APPEND FRONTMOST_LINKED_CMAKE WebP)
  list(APPEND FRONTMOST_LINKED_PC libwebp)
  list(APPEND FRONTMOST_LINKED_DEB libwebp-dev)
endif()
if(FRONTMOST_DRACO)
  list(APPEND FRONTMOST_LINKED_CMAKE draco)
  list(APPEND FRONTMOST_LINKED_PC draco)
  list(APPEND FRONTMOST_LINKED_DEB libdraco-dev)
endif()
if(FRONTMOST_MESHOPT) # without a pkg-config module, so that frontmost.pc names the library
  list(APPEND FRONTMOST_LINKED_CMAKE meshoptimizer)
  list(APPEND FRONTMOST_LINKED_DEB libmeshoptimizer-dev)
endif()
if(FRONTMOST_3MF)
  list(APPEND FRONTMOST_LINKED_CMAKE LibZip EXPAT)
  list(APPEND FRONTMOST_LINKED_PC libzip expat)
  list(APPEND FRONTMOST_LINKED_DEB libzip-dev libexpat1-dev)
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
  cmake/FindISAL.cmake cmake/FindLibZip.cmake cmake/FindWebP.cmake
  DESTINATION ${FRONTMOST_CMAKE_DIR} COMPONENT development)

# A static library cannot be linked without what it links itself, so there these are plain requirements: consumers
# need no --static.
list(JOIN FRONTMOST_LINKED_PC " " linked_modules)
set(FRONTMOST_PC_REQUIRES glm)
set(FRONTMOST_PC_LIBS "")
if(frontmost_kind STREQUAL STATIC_LIBRARY)
  set(FRONTMOST_PC_REQUIRES "glm ${linked_modules}")
  if(FRONTMOST_MESHOPT)
    set(FRONTMOST_PC_LIBS " -lmeshoptimizer")
  endif()
endif()
file(RELATIVE_PATH FRONTMOST_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/frontmost.pc.in ${PROJECT_BINARY_DIR}/frontmost.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/frontmost.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# The program prints its own manual page and completions, from the table that its parser reads.
function(frontmost_words file destination)
  add_custom_command(OUTPUT ${file} COMMAND frontmost_cli ${ARGN} > ${file} DEPENDS frontmost_cli VERBATIM
    WORKING_DIRECTORY ${PROJECT_BINARY_DIR})
  set_property(GLOBAL APPEND PROPERTY frontmost_words ${PROJECT_BINARY_DIR}/${file})
  install(FILES ${PROJECT_BINARY_DIR}/${file} DESTINATION ${destination} COMPONENT program)
endfunction()

if(TARGET frontmost_cli)
  install(TARGETS frontmost_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/words)
  frontmost_words(words/frontmost.1 ${CMAKE_INSTALL_MANDIR}/man1 man)
  frontmost_words(words/frontmost ${CMAKE_INSTALL_DATADIR}/bash-completion/completions completion bash)
  frontmost_words(words/_frontmost ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions completion zsh)
  frontmost_words(words/frontmost.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d completion fish)
  get_property(words GLOBAL PROPERTY frontmost_words)
  add_custom_target(frontmost_words ALL DEPENDS ${words})
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(FILES README.md CHANGELOG.md docs/batch.md docs/command-line.md docs/conventions.md docs/drawings.md docs/formats.md
  docs/many-machines.md docs/page.md docs/python.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
