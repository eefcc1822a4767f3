// SPDX-License-Identifier: Apache-2.0
// Memory of many pages: large pages, one block for the many Buffers of one call, and prefetching.
//
// The first touch of a 4 KiB page costs about as much as writing it several times, and every distant look-up misses the
// processor's table of pages. Large pages (2 MiB) avoid both. Large Buffers use them on their own; other arrays ask for
// them here, and small Buffers share them in an Arena:
//
//   an Arena's slab, in large pages
//   +------+--------+----------+--------------+--------------------------------+
//   | slab | Buffer |  Buffer  | Buffer       |          room                  |
//   +------+--------+----------+--------------+--------------------------------+
//                                             ^ next: moves back to the left when the last Buffers are dropped
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

#include "frontmost/base.h"

namespace frontmost {

/// Asks the system to back [start, start + bytes), which was not touched yet, by large pages. This is only a hint, and
/// does nothing if it would not pay.
void want_large_pages(void* start, std::size_t bytes);

/// Makes the pages of a range now, on several threads, instead of one by one at first touch. Keeps the range's
/// contents. Does nothing for ranges of a few pages, or if the system lacks the means.
void populate_pages(void* start, std::size_t bytes, const Execution& execution);

/// Does values.reserve(count), in large pages that are populated at once.
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

/// While an Arena lives, the Buffers of its thread lie side by side in large pages, as long as there is room. Without
/// an Arena, the first touch of thousands of small pages takes a third of draw_lines() in a new process. Buffers may
/// outlive the Arena, and any thread may drop them in any order; their room is free again once later Buffers are gone,
/// too. Arenas must be destroyed in the reverse order of their making, on the same thread.
class Arena {
 public:
  /// False under AddressSanitizer, which finds reads beyond a Buffer only if nothing lies beside it. False in
  /// WebAssembly, which has no pages, and where code for threads runs in modules without thread-local memory.
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

  /// At least the room that a Buffer takes beside its contents, in bytes.
  static constexpr std::size_t beside = 128;

  /// Makes room for `bytes`, at most 28 MiB, or no room if there is no memory. Untouched room costs nothing.
  explicit Arena(std::size_t bytes);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

 private:
  detail::Slab* slab_;
  detail::Slab* outer_;
};

/// The bits of a number as another type of the same size. WebAssembly's compiler has no std::bit_cast.
template <class To, class From>
[[nodiscard]] inline To bits_as(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

/// Prefetches the cache line of an address that is read soon. Any address is allowed.
inline void prefetch_line(const void* address) {
  __builtin_prefetch(address);
  // g++ 12 treats a function that only prefetches as one without effect, and drops calls of it.
  asm volatile("");
}

}  // namespace frontmost
