// SPDX-License-Identifier: Apache-2.0
// Where the sub-samples of a pixel are.
#pragma once

#include <array>
#include <vector>

#include "frontmost/abuffer.h"

namespace frontmost::abuffer_detail {

/// Positions from the pixel's top left corner. Every pattern lies on multiples of 1/16 pixel, so that edge functions
/// may be shifted right by 4 before stepping from sample to sample: exact, and a step is a multiple of dx or -dy.
struct SamplePattern {
  static constexpr int max_count = 64;
  static constexpr int unit = 16;  ///< 1/256 pixels in a step

  int count = 1;
  std::array<std::int32_t, max_count> x{}, y{};  ///< in 1/16 pixel
  std::int32_t low_x = 0, high_x = 0, low_y = 0, high_y = 0;

  [[nodiscard]] std::uint64_t full() const {
    return count == max_count ? ~std::uint64_t(0) : (std::uint64_t(1) << count) - 1;
  }
  /// In 1/256 pixel.
  [[nodiscard]] std::vector<glm::ivec2> positions() const;
};

/// The view's own samples for grid 0. \throws Error bad_argument unless the grid is 0, 2, 4 or 8.
[[nodiscard]] SamplePattern sample_pattern(const View& view, int grid);

}  // namespace frontmost::abuffer_detail
