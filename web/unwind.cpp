// SPDX-License-Identifier: Apache-2.0
// Exceptions with threads. Code compiled by clang 14 leaves what it asks a handler in one place for all threads;
// emscripten's libunwind for threads looks for it in a place for each, and nothing would ever be caught. So that file
// of it is compiled here once more, with one place.
//
// Two threads that catch by type at the same moment would disturb each other. Loops on threads catch everything alike
// (base/parallel.cpp), which asks nothing; images that are wrong are sorted out before the loop that decodes them.
#define __USING_WASM_EXCEPTIONS__
#define _LIBUNWIND_DISABLE_VISIBILITY_ANNOTATIONS
#include <config.h>
#include <unwind.h>

#include <cstdint>

#define thread_local
extern "C" {
#include <Unwind-wasm.c>
}
