// SPDX-License-Identifier: Apache-2.0
// Memory of many pages: large pages, one piece for the many Buffers of one call, and asking for lines ahead of their
// use.
//
// The first touch of a 4 KiB page costs about as much as writing it several times, and every look-up far away misses
// the processor's table of pages: large pages (2 MiB) spare both. Buffers have them by themselves where they are large
// enough; other arrays ask for them here, and small Buffers share them in an Arena:
//
//   an Arena's slab, in large pages
//   +------+--------+----------+--------------+--------------------------------+
//   | slab | Buffer |  Buffer  | Buffer       |          room                  |
//   +------+--------+----------+--------------+--------------------------------+
//                                             ^ next: it goes back to the left when the last Buffers are dropped
#pragma once

#include <cstddef>
#include <vector>

#include "frontmost/base.h"

namespace frontmost {

/// Asks the system to back [start, start + bytes), which was not touched yet, by large pages. Only a wish; nothing
/// happens where it would not pay.
void want_large_pages(void* start, std::size_t bytes);

/// Has the system make the pages of a range now, by several threads, instead of one by one when they are touched.
/// The range's contents stay. Nothing happens for ranges of a few pages, or where the system does not know how.
void populate_pages(void* start, std::size_t bytes, const Execution& execution);

/// values.reserve(count) in large pages that are there.
template <class T>
void reserve_large(std::vector<T>& values, std::size_t count, const Execution& execution) {
  if (count <= values.capacity()) return;
  values.reserve(count);
  T* const start = values.data() + values.size();
  const std::size_t bytes = (count - values.size()) * sizeof(T);
  want_large_pages(start, bytes);
  populate_pages(start, bytes, execution);
}

namespace detail {
struct Slab;
}

/// While it lives, the Buffers of the thread that made it lie side by side in large pages, as long as there is room:
/// the first touch of thousands of small pages, which Buffers of less than a large page have each by itself, was a
/// third of draw_lines() in a new process. Buffers may outlive it, and may be dropped in any order by any thread; their
/// room is there again when those made after them are gone, too. To be destroyed in the opposite order of making, on
/// the same thread.
class Arena {
 public:
  /// Not under AddressSanitizer, which finds what reads beyond a Buffer's end where nothing lies beside it; nor in
  /// WebAssembly, which has no pages to be touched, and where code for threads runs in modules without them, which have
  /// no memory of a thread's own.
  static constexpr bool has_room =
#if defined(__SANITIZE_ADDRESS__) || defined(__wasm__)
      false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
      false;
#else
      true;
#endif
#else
      true;
#endif

  /// With room for so many bytes, at most 28 MiB, or none where there is no memory. What is not touched costs nothing.
  explicit Arena(std::size_t bytes);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

 private:
  detail::Slab* slab_;
  detail::Slab* outer_;
};

/// Asks for the cache line of an address that is read soon. Any address will do.
inline void prefetch_line(const void* address) {
  __builtin_prefetch(address);
  // g++ 12 takes a function that does nothing but prefetch for one without effect, and drops the calls of it.
  asm volatile("");
}

}  // namespace frontmost
