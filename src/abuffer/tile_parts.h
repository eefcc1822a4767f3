// SPDX-License-Identifier: Apache-2.0
// From lists of tiles, which come in any order, to the lists of a picture, pixel by pixel in one array.
#pragma once

#include <algorithm>
#include <vector>

#include "abuffer/plan/frame_plan.h"

namespace frontmost::abuffer_detail {

/// The lists of one rectangle of pixels.
template <class T>
struct TilePart {
  Rectangle pixels;
  std::vector<std::uint32_t> begin;  ///< by pixel, row by row; and the end of the last
  std::vector<T> items;
};

/// By pixel of the picture, where its list begins; and the end of the last. Every pixel is in one part at most.
template <class T>
[[nodiscard]] Buffer<std::uint64_t> beginnings(const View& view, const std::vector<TilePart<T>>& parts) {
  Buffer<std::uint64_t> first(view.pixel_count() + 1, 0);
  for (const TilePart<T>& part : parts)
    for (int y = 0; y < part.pixels.height; ++y)
      for (int x = 0; x < part.pixels.width; ++x) {
        const std::size_t at =
            std::size_t(part.pixels.y + y) * std::size_t(view.width) + std::size_t(part.pixels.x + x);
        const std::size_t p = std::size_t(y) * std::size_t(part.pixels.width) + std::size_t(x);
        // Lengths first, one place behind, then their sums: parts may come in any order.
        first[at + 1] = part.begin[p + 1] - part.begin[p];
      }
  for (std::size_t i = 0; i < view.pixel_count(); ++i) first[i + 1] += first[i];
  return first;
}

/// Calls put(place, item) for every item of a part.
template <class T, class Put>
void place_items(const TilePart<T>& part, const View& view, const Buffer<std::uint64_t>& first, const Put& put) {
  const auto width = std::size_t(part.pixels.width);
  for (std::size_t y = 0; y < std::size_t(part.pixels.height); ++y) {
    // The lists of a row are neighbours in both.
    const std::size_t at = (std::size_t(part.pixels.y) + y) * std::size_t(view.width) + std::size_t(part.pixels.x);
    std::uint64_t place = first[at];
    for (std::size_t i = part.begin[y * width]; i < part.begin[(y + 1) * width]; ++i) put(place++, part.items[i]);
  }
}

}  // namespace frontmost::abuffer_detail
