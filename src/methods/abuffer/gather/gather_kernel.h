// SPDX-License-Identifier: Apache-2.0
// Gathers the fragments of one rectangle of pixels, sorts them into lists, and cuts holes out of them.
//
//    gather_tile   fragments in the order of arrival; the fragments of each pixel are counted on the way
//    sort_lists    lists of pixels, sixteen pixels side by side, nearest first
//    cut_fragments takes holes out of the masks
#pragma once

#include <array>

#include "abuffer/gather/tile_scratch.h"

namespace frontmost::abuffer_detail {

/// Places of a pixel's sub-samples, from its top left corner. Every pattern lies on multiples of 1/16 pixel, so edge
/// functions may be shifted right by 4 before stepping from sample to sample: this is exact, and a step is a multiple
/// of dx or -dy.
struct SamplePattern {
  static constexpr int max_count = 64;
  static constexpr int unit = 16;  ///< 1/256 pixels in a step

  int count = 1;
  std::array<std::int32_t, max_count> x{}, y{};  ///< in 1/16 pixel
  std::int32_t low_x = 0, high_x = 0, low_y = 0, high_y = 0;

  [[nodiscard]] std::uint64_t full() const {
    return count == max_count ? ~std::uint64_t(0) : (std::uint64_t(1) << count) - 1;
  }
  /// Positions in 1/256 pixel.
  [[nodiscard]] std::vector<glm::ivec2> positions() const;
};

/// The pattern of a grid; grid 0 takes the view's own samples. \throws Error bad_argument unless the grid is 0, 2, 4 or
/// 8.
[[nodiscard]] SamplePattern sample_pattern(const View& view, int grid);

/// The input that all tiles of a frame share.
struct GatherInput {
  const FragmentPlan& plan;
  const SamplePattern& pattern;
  Isa isa;
};

/// A rectangle of a tile, and the tile, whose clusters and single triangles are searched.
struct GatherJob {
  Rectangle pixels;
  std::size_t tile;
};

enum class Gathered : std::uint8_t { nothing, something, too_much };

/// Fills the scratch with all fragments of the rectangle, in the order of arrival. `too_much`: there are more than
/// kMostOfTile; for rectangles of one pixel all are gathered. \throws Error limit_exceeded for more than kMostOfPixel
/// in one pixel.
[[nodiscard]] Gathered gather_tile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch);

/// Sorts gathered fragments into lists. Call once. O(n log^2 n) for lists of n fragments.
void sort_lists(Isa isa, GatherScratch& scratch);

/// Takes sub-samples that look through holes out of the masks. A mask may become 0; its fragment then shows nothing.
/// `pixels` is the rectangle that was gathered. O(fragments), or nothing if the scene has no cutouts.
void cut_fragments(const GatherInput& frame, const Rectangle& pixels, GatherScratch& scratch);

}  // namespace frontmost::abuffer_detail
