// SPDX-License-Identifier: Apache-2.0
// VisiblePixels: what a view of several samples shows, kept once wherever all samples of a pixel see the same.
//
//   first        | row 0     | row 1     | ...     what sample 0 of every pixel sees: primitive and key
//   mixed        0 0 0 1 1 0 0 ...                 a bit for each pixel whose samples see different primitives
//   others             | 1, 2, 3 | 1, 2, 3 |       for those alone what samples 1 and up see, as `places` tells
//
// Of most pictures it is a fifth of what a Visible takes, so that it is written and read in a fifth of the time: what
// colour needs, for which the depths of samples other than the first do not count.
#pragma once

#include "frontmost/visible.h"

namespace frontmost {

/// The front-most primitive at every sample of a view.
struct VisiblePixels {
  static constexpr int run = 16;  ///< pixels of a row, from a multiple of as many on, that share a number of `mixed`

  View view;      ///< of all samples
  Visible first;  ///< of sample 0, as planes of one sample
  /// [y][x / run]: bit x % run is set where the samples of a pixel see different primitives.
  Buffer<std::uint16_t> mixed;
  /// [y][x / run]: where in `others` the first mixed pixel of the run is; undefined without one.
  Buffer<std::uint32_t> places;
  /// Ids of samples 1 and up of one mixed pixel after another; the first `other_count` are used.
  Buffer<PrimitiveId> others;
  std::size_t other_count = 0;

  [[nodiscard]] std::size_t runs_across() const { return std::size_t((view.width + run - 1) / run); }
};

/// The same of planes: runs follow each other as pixels do. O(samples).
[[nodiscard]] VisiblePixels pixels_of(const Visible& visible);

/// Of a view, with nothing in it: every plane has its size, and is undefined. \throws Error as validate(view) does.
[[nodiscard]] VisiblePixels undefined_pixels(const View& view);

}  // namespace frontmost
