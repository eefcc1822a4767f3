# SPDX-License-Identifier: Apache-2.0
# What a build by emscripten needs: the packages that are headers alone, found where Debian has them without the rest of
# the machine's headers, which are not those of WebAssembly; and the options of every compilation.
#
# Everything is compiled once, for threads; a module that runs without them is linked from the same objects.

set(headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${headers})

# headers_of(PACKAGE TARGET FOLDER): lets find_package(PACKAGE) find TARGET, whose headers are in FOLDER.
function(headers_of package target folder)
  if(NOT EXISTS /usr/include/${folder})
    message(FATAL_ERROR "/usr/include/${folder} is not there: packages.txt names what a build needs")
  endif()
  file(CREATE_LINK /usr/include/${folder} ${headers}/${folder} SYMBOLIC)
  file(WRITE ${headers}/${package}Config.cmake "if(NOT TARGET ${target})
  add_library(${target} INTERFACE IMPORTED)
  set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${headers})
endif()\n")
  set(${package}_DIR ${headers} CACHE PATH "Written by the build" FORCE)
endfunction()

headers_of(hwy hwy::hwy hwy)
headers_of(glm glm::glm glm)
headers_of(nlohmann_json nlohmann_json::nlohmann_json nlohmann)

option(FRONTMOST_WEB_SIMD "Compile the kernels for WebAssembly's vectors; else for single numbers" ON)
add_compile_options(-fwasm-exceptions -pthread)
add_link_options(-fwasm-exceptions)
if(FRONTMOST_WEB_SIMD)
  add_compile_options(-msimd128)
endif()
# frontmost_small(FOLDER...): what people wait for once a file or a drawing is to be small before it is quick. Where
# folders are compiled as one, the options are those of the file that CMake writes for each. Headers that were compiled with
# others cannot be used there.
function(frontmost_small)
  if(FRONTMOST_TOGETHER)
    foreach(folder ${ARGN})
      string(MAKE_C_IDENTIFIER "unity_${folder}_0_cxx" file)
      set_source_files_properties(${CMAKE_BINARY_DIR}/src/CMakeFiles/frontmost.dir/Unity/${file}.cxx
        TARGET_DIRECTORY frontmost PROPERTIES COMPILE_OPTIONS -Oz SKIP_PRECOMPILE_HEADERS ON)
    endforeach()
  endif()
endfunction()

# One instruction set each: a table of one.
add_compile_definitions(HWY_COMPILE_ONLY_STATIC)
