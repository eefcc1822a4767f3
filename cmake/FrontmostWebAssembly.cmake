# SPDX-License-Identifier: Apache-2.0
# Options of every compilation by emscripten.
#
# Everything is compiled once, for threads; a module without threads is linked from the same objects.

option(FRONTMOST_WEB_SIMD "Compile the kernels for WebAssembly's vectors; else for single numbers" ON)
add_compile_options(-fwasm-exceptions -pthread)
add_link_options(-fwasm-exceptions)
if(FRONTMOST_WEB_SIMD)
  add_compile_options(-msimd128)
endif()

option(FRONTMOST_WEB_SMALL "Take the time to make the module small" ON)
if(FRONTMOST_WEB_SMALL) # cold code runs once for a file or a drawing, and a small module loads sooner
  set(FRONTMOST_COLD_FLAGS -Oz)
endif()
