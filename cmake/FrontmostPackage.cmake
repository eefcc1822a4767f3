# SPDX-License-Identifier: Apache-2.0
# Debian packages by CPack: frontmost (the program), libfrontmost-dev (library, headers, descriptions) and, if their
# modules are built, python3-frontmost, frontmost-mpi, frontmost-gl and frontmost-import.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME frontmost)
set(CPACK_PACKAGE_CONTACT "Frontmost maintainers <maintainers@frontmost.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)

# dpkg-shlibdeps finds the shared libraries that the program needs; only CMake knows those of a static library.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME frontmost)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"Pictures, depth and id maps of 3D models from the command line, without a
GPU or a display, the same pixels on every machine. Reads STL, PLY, OBJ, OFF,
glTF and 3MF; writes PNG, OpenEXR, PFM and NPY. With frontmost-import it also
reads STEP, IGES, BREP, FBX, COLLADA and more.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "frontmost-import, frontmost-gl")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libfrontmost-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
list(JOIN FRONTMOST_LINKED_DEB ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
string(PREPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libglm-dev, ")
if(NOT frontmost_kind STREQUAL STATIC_LIBRARY)
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libglm-dev, frontmost (= ${PROJECT_VERSION})")
endif()
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "The C++ library of Frontmost: headers, library, CMake and pkg-config files.")

if(TARGET frontmost_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-frontmost)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # The compiled part works with one version of Python only.
  math(EXPR next_minor "${FRONTMOST_PYTHON_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${FRONTMOST_PYTHON_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  if(NOT frontmost_kind STREQUAL STATIC_LIBRARY)
    string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", frontmost (= ${PROJECT_VERSION})")
  endif()
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"What can be seen of 3D models, for Python and NumPy: depths, ids, pictures,
drawings, and who hides whom, without a GPU or a display.")
endif()

if(TARGET frontmost_mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME frontmost-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "frontmost (= ${PROJECT_VERSION}), openmpi-bin")
  set(CPACK_COMPONENT_MPI_DESCRIPTION
"What frontmost render --mpi needs to share models that are larger than one
machine among the ranks of mpirun.")
endif()

if(TARGET frontmost_gl)
  list(APPEND CPACK_COMPONENTS_ALL gl)
  set(CPACK_DEBIAN_GL_PACKAGE_NAME frontmost-gl)
  set(CPACK_DEBIAN_GL_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_GL_PACKAGE_SHLIBDEPS ON)
  if(NOT frontmost_kind STREQUAL STATIC_LIBRARY)
    set(CPACK_DEBIAN_GL_PACKAGE_DEPENDS "frontmost (= ${PROJECT_VERSION})")
  endif()
  set(CPACK_DEBIAN_GL_PACKAGE_RECOMMENDS libgl-dev)
  set(CPACK_COMPONENT_GL_DESCRIPTION
"OpenGL 1.x, OSMesa and GLUT for programs that run without a display or a GPU.
Finished programs run unchanged by frontmost gl, and draw the same pixels on
every machine.")
endif()

if(TARGET frontmost-import)
  list(APPEND CPACK_COMPONENTS_ALL import)
  set(CPACK_DEBIAN_IMPORT_PACKAGE_NAME frontmost-import)
  set(CPACK_DEBIAN_IMPORT_PACKAGE_SHLIBDEPS ON)
  set(CPACK_COMPONENT_IMPORT_DESCRIPTION
"Lets frontmost read CAD files, STEP, IGES and BREP with their edges, and meshes
in formats such as FBX, COLLADA and 3DS. It runs as a process of its own, because
the libraries that read these formats crash on broken files.")
endif()

include(CPack)
