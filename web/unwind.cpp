// SPDX-License-Identifier: Apache-2.0
// Exceptions with threads. Code compiled by clang 14 stores the question to a handler in one place for all threads.
// Emscripten's libunwind for threads looks for it in a place for each thread, so nothing would ever be caught. This
// file compiles that part of libunwind again, with one place.
//
// Two threads that catch by type at the same moment would disturb each other. Loops on threads catch all exceptions
// alike (base/parallel.cpp), which needs no question; wrong images are sorted out before the loop that decodes them.
#define __USING_WASM_EXCEPTIONS__
#define _LIBUNWIND_DISABLE_VISIBILITY_ANNOTATIONS
#include <config.h>
#include <unwind.h>

#include <cstdint>

#define thread_local
extern "C" {
#include <Unwind-wasm.c>
}
