// SPDX-License-Identifier: Apache-2.0
// Joins the lists of tiles, which arrive in any order, into one array that holds the list of each pixel.
//
//    parts, as tiles end    [tile 5 | lists]  [tile 0 | lists]  [tile 2 | lists] ...
//    first                  pixel 0: 0   pixel 1: 3   pixel 2: 3   ...   the running sum of all lengths
//    result                 | pixel 0 | pixel 1 | pixel 2 | ...           each list at its pixel's place
#pragma once

#include <mutex>
#include <vector>

#include "abuffer/plan/frame_plan.h"
#include "base/parallel.h"

namespace frontmost::abuffer_detail {

/// The lists of one rectangle of pixels.
template <class T>
struct TilePart {
  Rectangle pixels;
  std::vector<std::uint32_t> begin;  ///< by pixel, row by row; then the end of the last list
  std::vector<T> items;
};

/// The parts of a picture, in the order of arrival. Every pixel is in at most one part.
template <class T>
class TileParts {
 public:
  /// More than `most` items cause an error with this place and reason.
  TileParts(const View& view, std::uint64_t most, const char* place, const char* reason)
      : view_(view), most_(most), place_(place), reason_(reason) {}

  /// May be called by several threads at once. \throws Error limit_exceeded.
  void add(TilePart<T> part) {
    const std::lock_guard lock(mutex_);
    item_count_ += part.items.size();
    // The number of items is known only now. The parts before this one are stored already, but each is bounded by the
    // limit of a tile.
    if (item_count_ > most_) throw Error(ErrorCode::limit_exceeded, place_, reason_);
    parts_.push_back(std::move(part));
  }

  /// Returns the beginning of the list of each pixel of the picture, and then the end of the last list.
  [[nodiscard]] Buffer<std::uint64_t> beginnings() const {
    Buffer<std::uint64_t> first(view_.pixel_count() + 1, 0);
    for (const TilePart<T>& part : parts_)
      for (int y = 0; y < part.pixels.height; ++y)
        for (int x = 0; x < part.pixels.width; ++x) {
          const std::size_t at =
              std::size_t(part.pixels.y + y) * std::size_t(view_.width) + std::size_t(part.pixels.x + x);
          const std::size_t p = std::size_t(y) * std::size_t(part.pixels.width) + std::size_t(x);
          // Lengths are stored one entry further on and summed later, because parts come in any order.
          first[at + 1] = part.begin[p + 1] - part.begin[p];
        }
    for (std::size_t i = 0; i < view_.pixel_count(); ++i) first[i + 1] += first[i];
    return first;
  }

  /// Calls put(place, item) for every item of every part, on all threads; `first` holds the beginnings of the lists.
  /// Frees the memory of the parts one by one.
  template <class Put>
  void place(const Buffer<std::uint64_t>& first, const Put& put, const Execution& execution) {
    constexpr std::size_t kGrain = 16;
    parallel_for(execution, parts_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        place_part(parts_[i], first, put);
        parts_[i] = {};
      }
    });
  }

 private:
  template <class Put>
  void place_part(const TilePart<T>& part, const Buffer<std::uint64_t>& first, const Put& put) const {
    const auto width = std::size_t(part.pixels.width);
    for (std::size_t y = 0; y < std::size_t(part.pixels.height); ++y) {
      // The lists of a row are neighbours in both arrays.
      const std::size_t at = (std::size_t(part.pixels.y) + y) * std::size_t(view_.width) + std::size_t(part.pixels.x);
      std::uint64_t place = first[at];
      for (std::size_t i = part.begin[y * width]; i < part.begin[(y + 1) * width]; ++i) put(place++, part.items[i]);
    }
  }

  const View& view_;
  const std::uint64_t most_;
  const char *const place_, *const reason_;
  std::mutex mutex_;
  std::uint64_t item_count_ = 0;
  std::vector<TilePart<T>> parts_;
};

}  // namespace frontmost::abuffer_detail
