// SPDX-License-Identifier: Apache-2.0
// One piece of memory for the many Buffers of one call.
#pragma once

#include <cstddef>

namespace frontmost {

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
  /// Not under AddressSanitizer, which finds what reads beyond a Buffer's end where nothing lies beside it.
  static constexpr bool has_room =
#if defined(__SANITIZE_ADDRESS__)
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

}  // namespace frontmost
