# SPDX-License-Identifier: Apache-2.0
# Compiler settings that all targets share.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT EMSCRIPTEN) # where code is linked in one piece, and position-independent code only costs time
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

add_library(frontmost_flags INTERFACE)
# No fused multiply-add, so that all targets give the same bytes.
target_compile_options(frontmost_flags INTERFACE -ffp-contract=off -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
# Checks of alignments take a quarter of the time of compiling under AddressSanitizer. The preset asan has them in the parts
# that read input; ./dev test --all and ./dev fuzz have them everywhere.
set(FRONTMOST_CHECKS "" CACHE STRING "Options of all files, for more checks by a sanitizer")
set(FRONTMOST_INPUT_CHECKS "" CACHE STRING "Options for more checks of the parts files and gl, which read bytes that users bring")
target_compile_options(frontmost_flags INTERFACE ${FRONTMOST_CHECKS})
# g++ 12 warns about its own array headers when inlining vectors (GCC bug 105562).
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(frontmost_flags INTERFACE -Wno-stringop-overflow -Wno-array-bounds -Wno-maybe-uninitialized)
endif()
# On 64-bit Arm, Highway compiles for processors with cryptography, which is not used here. g++ needs that option for
# whole files, or its generated code (constructors, closures) does not match the rest.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  include(CheckCXXSourceCompiles)
  check_cxx_source_compiles("#ifndef __ARM_FEATURE_CRYPTO
    #error
    #endif
    int main() {}" FRONTMOST_HAS_CRYPTO)
  if(NOT FRONTMOST_HAS_CRYPTO)
    target_compile_options(frontmost_flags INTERFACE -march=armv8-a+crypto)
  endif()
endif()

# By default g++ collects garbage all through a compilation, which takes 3 to 10 % of its time. The parameter is the
# heap size in KiB at which collection begins.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(frontmost_flags INTERFACE --param=ggc-min-heapsize=500000)
endif()

# Cold code takes half as long again to build at -O3, without measurable gain.
if(EMSCRIPTEN) # whose compiler has no -Og
  set(quick_to_compile -O1)
else()
  set(quick_to_compile -Og)
endif()
set(FRONTMOST_COLD_FLAGS $<$<CONFIG:Release>:${quick_to_compile}> CACHE STRING "Compiler options of code that no speed depends on")
function(frontmost_cold target)
  target_compile_options(${target} PRIVATE ${FRONTMOST_COLD_FLAGS})
endfunction()

# Only builds with assertions need Highway's library, which costs every start 2 ms.
include(CheckLinkerFlag)
check_linker_flag(CXX -Wl,--as-needed FRONTMOST_HAS_AS_NEEDED)
if(FRONTMOST_HAS_AS_NEEDED)
  target_link_options(frontmost_flags INTERFACE -Wl,--as-needed)
endif()

# Programs are linked without unreachable functions: the command line becomes 6 % smaller, and a program with the
# z-buffer alone half as large.
check_linker_flag(CXX -Wl,--gc-sections FRONTMOST_HAS_GC_SECTIONS)
if(FRONTMOST_HAS_GC_SECTIONS)
  target_compile_options(frontmost_flags INTERFACE $<$<CONFIG:Release>:-ffunction-sections>)
  target_link_options(frontmost_flags INTERFACE $<$<CONFIG:Release>:-Wl,--gc-sections>)
endif()

# A sanitizer's build links 45 programs of 100 MB; lld takes a fifth of the time of ld.
option(FRONTMOST_LLD "Link by lld where it is there" OFF)
if(FRONTMOST_LLD)
  check_linker_flag(CXX -fuse-ld=lld FRONTMOST_HAS_LLD)
  if(FRONTMOST_HAS_LLD)
    target_link_options(frontmost_flags INTERFACE -fuse-ld=lld)
  endif()
endif()

# Headers take most of the time of a first build. So common headers are compiled once for each target, and the files of
# a folder are compiled together. With a compiler cache, set OFF and CMAKE_CXX_COMPILER_LAUNCHER: a change of one file
# then compiles that file alone.
option(FRONTMOST_TOGETHER "Precompile common headers, and compile the files of a folder as one" ON)
if(NOT FRONTMOST_TOGETHER)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()

# frontmost_together(TARGET BYTES [BY_FOLDER]) : joins consecutive sources into units of about BYTES bytes; with
# BY_FOLDER, sources of different folders are not joined. Kernels are compiled alone, because they include themselves
# once for each instruction set. CMake compiles files with options of their own alone.
function(frontmost_together target bytes)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources EXCLUDE REGEX "_kernel[.]cpp$|^[$]<")
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${FRONTMOST_TOGETHER} UNITY_BUILD_MODE GROUP)
  set(size 0)
  set(group "")
  foreach(source ${sources})
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE path)
    if(NOT EXISTS ${path}) # the build generates it
      continue()
    endif()
    cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE name)
    set(folder "")
    if(ARGC GREATER 2 AND name MATCHES "^([^/]+)/")
      set(folder ${CMAKE_MATCH_1})
    endif()
    if(NOT group OR size GREATER_EQUAL bytes OR NOT folder STREQUAL last_folder)
      cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE group)
      string(REGEX REPLACE "[.]cpp$" "" group ${group})
      string(MAKE_C_IDENTIFIER ${group} group)
      set(size 0)
      set(last_folder "${folder}")
    endif()
    file(SIZE ${path} more)
    math(EXPR size "${size} + ${more}")
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()
set(FRONTMOST_COMMON_HEADERS <algorithm> <array> <atomic> <cmath> <cstdint> <cstring> <functional> <limits> <map> <memory>
  <optional> <span> <string> <string_view> <tuple> <utility> <vector> <glm/glm.hpp>)
