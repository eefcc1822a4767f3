# SPDX-License-Identifier: Apache-2.0
# Compiler settings that every target of the house shares.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

add_library(frontmost_flags INTERFACE)
# The same bytes everywhere: no fused multiply-add that only some targets have.
target_compile_options(frontmost_flags INTERFACE -ffp-contract=off -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
# g++ 12 warns about its own array headers when inlining vectors (GCC bug 105562).
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(frontmost_flags INTERFACE -Wno-stringop-overflow -Wno-array-bounds -Wno-maybe-uninitialized)
endif()

# Cold code with heavy headers: at -O3 it takes twice as long to build, for nothing that can be measured.
set(FRONTMOST_COLD_FLAGS $<$<CONFIG:Release>:-O1> CACHE STRING "Compiler options of code that no speed depends on")
function(frontmost_cold target)
  target_compile_options(${target} PRIVATE ${FRONTMOST_COLD_FLAGS})
endfunction()

# Highway's library is needed by builds with assertions only, and costs every start 2 ms.
include(CheckLinkerFlag)
check_linker_flag(CXX -Wl,--as-needed FRONTMOST_HAS_AS_NEEDED)
if(FRONTMOST_HAS_AS_NEEDED)
  target_link_options(frontmost_flags INTERFACE -Wl,--as-needed)
endif()

find_program(FRONTMOST_CCACHE ccache)
mark_as_advanced(FRONTMOST_CCACHE)
if(FRONTMOST_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${FRONTMOST_CCACHE})
endif()
