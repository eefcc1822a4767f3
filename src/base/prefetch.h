// SPDX-License-Identifier: Apache-2.0
// Asking for memory ahead of its use.
#pragma once

namespace frontmost {

/// Asks for the cache line of an address that is read soon. Any address will do.
inline void prefetch_line(const void* address) {
  __builtin_prefetch(address);
  // g++ 12 takes a function that does nothing but prefetch for one without effect, and drops the calls of it.
  asm volatile("");
}

}  // namespace frontmost
