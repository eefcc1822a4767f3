# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` installs: the library with its CMake and pkg-config descriptions, the program, its manual page
# and its completions.
include(CMakePackageConfigHelpers)

set(FRONTMOST_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/frontmost)
get_target_property(frontmost_kind frontmost_core TYPE)

# Dependencies that users of the static libraries must link: CMake packages for each part, and pkg-config modules and
# Debian packages for all together, in this order. The program's own dependencies (nlohmann-json, CLI11, fmt) never
# reach a consumer.
set(FRONTMOST_LINKED_PC "")
set(FRONTMOST_LINKED_DEB "")
# frontmost_links(PARTS CMAKE_PACKAGE PKG_CONFIG_MODULE DEBIAN_PACKAGE)
function(frontmost_links parts package module debian)
  foreach(part ${parts})
    set(FRONTMOST_LINKED_${part} ${FRONTMOST_LINKED_${part}} ${package} PARENT_SCOPE)
  endforeach()
  set(FRONTMOST_LINKED_PC ${FRONTMOST_LINKED_PC} ${module} PARENT_SCOPE)
  set(FRONTMOST_LINKED_DEB ${FRONTMOST_LINKED_DEB} ${debian} PARENT_SCOPE)
endfunction()
frontmost_links("${FRONTMOST_PARTS}" hwy libhwy libhwy-dev)
frontmost_links("${FRONTMOST_PARTS}" Threads "" "")
if(FRONTMOST_PNG)
  frontmost_links(files PNG libpng libpng-dev)
  frontmost_links("drawings;files" ZLIB zlib zlib1g-dev)
endif()
if(FRONTMOST_JPEG)
  frontmost_links(files JPEG libjpeg libjpeg-dev)
endif()
if(FRONTMOST_OPENEXR)
  frontmost_links(files OpenEXR OpenEXR libopenexr-dev)
endif()
if(FRONTMOST_ISAL)
  frontmost_links(files ISAL libisal libisal-dev)
endif()
if(FRONTMOST_WEBP)
  frontmost_links(files WebP libwebp libwebp-dev)
endif()
if(FRONTMOST_DRACO)
  frontmost_links(files draco draco libdraco-dev)
endif()
if(FRONTMOST_MESHOPT) # has no pkg-config module, so frontmost.pc names the library
  frontmost_links(files meshoptimizer "" libmeshoptimizer-dev)
endif()
if(FRONTMOST_3MF)
  frontmost_links(files LibZip libzip libzip-dev)
  frontmost_links(files EXPAT expat libexpat1-dev)
endif()
# Lines of the CMake description about the parts.
set(FRONTMOST_PART_LINES "")
foreach(part ${FRONTMOST_PARTS})
  get_property(used GLOBAL PROPERTY frontmost_used_by_${part})
  list(JOIN used " " used)
  set(linked "")
  if(frontmost_kind STREQUAL STATIC_LIBRARY)
    list(JOIN FRONTMOST_LINKED_${part} " " linked)
  endif()
  string(APPEND FRONTMOST_PART_LINES "set(frontmost_${part}_uses ${used})\nset(frontmost_${part}_links ${linked})\n")
endforeach()

list(TRANSFORM FRONTMOST_PARTS PREPEND frontmost_ OUTPUT_VARIABLE part_targets)
install(TARGETS frontmost ${part_targets} EXPORT frontmostTargets
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

# OpenGL's calls are a package of their own: the library, its names for finished programs, and what programs are
# compiled with.
if(TARGET frontmost_gl)
  install(TARGETS frontmost_gl EXPORT frontmostGlTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT gl)
  install(TARGETS frontmost_glut LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT gl)
  install(EXPORT frontmostGlTargets NAMESPACE frontmost:: DESTINATION ${FRONTMOST_CMAKE_DIR} COMPONENT gl)
  install(DIRECTORY include/frontmost-gl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT gl)
  foreach(name ${FRONTMOST_GL_NAMES})
    string(REGEX MATCH "glut" kind ${name})
    if(NOT kind)
      set(kind gl)
    endif()
    set(link ${PROJECT_BINARY_DIR}/links/${name})
    file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/links)
    file(CREATE_LINK ../libfrontmost-${kind}.so.${PROJECT_VERSION_MAJOR} ${link} SYMBOLIC)
    install(FILES ${link} DESTINATION ${CMAKE_INSTALL_LIBDIR}/frontmost-gl COMPONENT gl)
  endforeach()
  file(RELATIVE_PATH FRONTMOST_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(cmake/frontmost-gl.pc.in ${PROJECT_BINARY_DIR}/frontmost-gl.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/frontmost-gl.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT gl)
  install(FILES docs/opengl.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/frontmost-gl COMPONENT gl)
endif()

# A static library cannot be linked without its own dependencies, so these are plain requirements there, and consumers
# need no --static.
list(JOIN FRONTMOST_LINKED_PC " " linked_modules)
set(FRONTMOST_PC_REQUIRES glm)
list(REVERSE part_targets) # a library comes before those that it uses
list(TRANSFORM part_targets PREPEND -l)
list(JOIN part_targets " " FRONTMOST_PC_LIBS)
if(frontmost_kind STREQUAL STATIC_LIBRARY)
  set(FRONTMOST_PC_REQUIRES "glm ${linked_modules}")
  if(FRONTMOST_MESHOPT)
    string(APPEND FRONTMOST_PC_LIBS " -lmeshoptimizer")
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
if(TARGET frontmost-import)
  install(TARGETS frontmost-import RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT import)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(FILES README.md CHANGELOG.md docs/batch.md docs/command-line.md docs/conventions.md docs/drawings.md docs/formats.md
  docs/many-machines.md docs/page.md docs/python.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
