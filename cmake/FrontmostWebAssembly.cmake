# SPDX-License-Identifier: Apache-2.0
# The options of every compilation by emscripten.
#
# Everything is compiled once, for threads; a module that runs without them is linked from the same objects.

option(FRONTMOST_WEB_SIMD "Compile the kernels for WebAssembly's vectors; else for single numbers" ON)
add_compile_options(-fwasm-exceptions -pthread)
add_link_options(-fwasm-exceptions)
if(FRONTMOST_WEB_SIMD)
  add_compile_options(-msimd128)
endif()

option(FRONTMOST_WEB_SMALL "Take the time to make the module small" ON)
# frontmost_small(FOLDER...): what people wait for once a file or a drawing is to be small before it is quick. Where
# folders are compiled as one, the options are those of the file that CMake writes for each. Headers that were compiled with
# others cannot be used there.
function(frontmost_small)
  if(FRONTMOST_TOGETHER AND FRONTMOST_WEB_SMALL)
    foreach(folder ${ARGN})
      string(MAKE_C_IDENTIFIER "unity_${folder}_0_cxx" file)
      set_source_files_properties(${CMAKE_BINARY_DIR}/src/CMakeFiles/frontmost.dir/Unity/${file}.cxx
        TARGET_DIRECTORY frontmost PROPERTIES COMPILE_OPTIONS -Oz SKIP_PRECOMPILE_HEADERS ON)
    endforeach()
  endif()
endfunction()
