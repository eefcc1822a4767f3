// SPDX-License-Identifier: Apache-2.0
// Large pages for arrays that are not Buffers. The first touch of a 4 KiB page costs about as much as writing it several
// times, and every look-up far away misses the processor's table of pages: large ones spare both.
#pragma once

#include <cstddef>
#include <vector>

namespace frontmost {

/// Asks the system to back [start, start + bytes), which was not touched yet, by large pages. Only a wish; nothing
/// happens where it would not pay.
void want_large_pages(void* start, std::size_t bytes);

/// values.reserve(count) in large pages.
template <class T>
void reserve_large(std::vector<T>& values, std::size_t count) {
  if (count <= values.capacity()) return;
  values.reserve(count);
  want_large_pages(values.data() + values.size(), (count - values.size()) * sizeof(T));
}

}  // namespace frontmost
