// SPDX-License-Identifier: Apache-2.0
// Large pages for arrays that are not Buffers. The first touch of a 4 KiB page costs about as much as writing it
// several times, and every look-up far away misses the processor's table of pages: large ones spare both.
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

}  // namespace frontmost
