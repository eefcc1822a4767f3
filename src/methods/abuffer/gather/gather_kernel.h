// SPDX-License-Identifier: Apache-2.0
// Gathers the fragments of one rectangle of pixels, sorts them into lists, and cuts holes out of them. The private
// memory of one thread holds the fragments in the order of arrival, and then sorted:
//
//    counts      pixel 0   1   2  ...                   fragments of each pixel so far
//    arrived     key | place | triangle | mask          one entry a fragment, in the order of arrival
//    slots       group 0: slot 0 of 16 pixels, slot 1 of 16 pixels, ... | group 1: ...       after sorting
//
// A slot is 64 bits: the bits of the key above the complement of the fragment's number. So integer comparison sorts by
// key; equal keys are sorted by id afterwards.
#pragma once

#include <array>

#include "abuffer/plan/frame_plan.h"
#include "base/memory.h"
#include "view/triangle_keys.h"

namespace frontmost::abuffer_detail {

inline constexpr std::size_t kTilePixels = std::size_t(kTileSize) * kTileSize;
/// Pixels are numbered by groups: blocks of 4 x 4 pixels, which are sorted and composited together.
inline constexpr std::size_t kGroup = 16, kGroups = kTilePixels / kGroup;
inline constexpr int kBlocksAcross = kTileSize / 4;

/// A fragment's pixel and its rank in the pixel share one word.
inline constexpr int kRankBits = 20;
inline constexpr std::uint32_t kMostOfPixel = (1u << kRankBits) - 1;

/// The most fragments of a tile; a tile that holds more is divided. This limits Arrived to 5 MB; its sorted lists need
/// 8 bytes a slot.
inline constexpr std::size_t kMostOfTile = std::size_t(1) << 18;
/// The most fragments that one step of gathering may add before the room is checked again.
inline constexpr std::size_t kMostAtOnce = kTilePixels + 64;

[[nodiscard]] inline std::uint32_t pixel_number(std::uint32_t x, std::uint32_t y) {
  return ((y >> 2) * kBlocksAcross + (x >> 2)) * 16 + (y & 3) * 4 + (x & 3);
}

/// Key planes of the triangles of a tile, as in view/triangle_keys.h. The key at a point is (k0 + dx*gx) + dy*gy,
/// limited to [low, high]. (dx, dy) is the point's distance from (x0, y0), in 1/256 pixel, and (x0, y0) is relative to
/// the tile's corner. SteepKeys give the keys of steep triangles. `slack` bounds the rounding of the difference of two
/// keys of one pixel. `half` bounds the difference between the keys of a pixel and the key at its centre.
struct LocalTriangles {
  std::size_t count = 0;
  Buffer<std::int32_t> x0, y0;
  Buffer<float> k0, gx, gy, low, high, slack, half;
  Buffer<std::uint32_t> steep;  ///< number in `steep_keys`, or no_index
  Buffer<PrimitiveId> id;
  std::vector<SteepKeys> steep_keys;

  void clear() {
    count = 0;
    steep_keys.clear();
  }
  /// Makes room for `more` triangles.
  void reserve(std::size_t more);
  [[nodiscard]] float key_at(std::size_t t, std::int32_t x, std::int32_t y) const {
    if (steep[t] != no_index) return steep_keys[steep[t]].at(x, y);
    const float key = (k0[t] + float(x - x0[t]) * gx[t]) + float(y - y0[t]) * gy[t];
    return std::min(std::max(key, low[t]), high[t]);
  }
};

/// Fragments in the order of arrival. Number 0 stands for no fragment: it covers nothing and lies behind everything.
struct Arrived {
  static constexpr std::size_t first = 1;
  std::size_t count = 0, capacity = 0;
  Buffer<std::uint32_t> key;                  ///< bits of the float
  Buffer<std::uint32_t> place;                ///< pixel << kRankBits | rank
  Buffer<std::uint32_t> triangle;             ///< number in LocalTriangles
  Buffer<std::uint32_t> mask_low, mask_high;  ///< sub-samples 0 to 31 and 32 to 63

  void grow(std::size_t wanted);
  [[nodiscard]] std::uint64_t mask(std::size_t n) const { return std::uint64_t(mask_high[n]) << 32 | mask_low[n]; }
  [[nodiscard]] float key_of(std::size_t n) const { return bits_as<float>(key[n]); }
};

struct GatherScratch {
  GatherScratch();

  LocalTriangles triangles;
  Arrived arrived;
  Buffer<std::uint32_t> counts;      ///< by pixel: the number of fragments, and after sorting the beginning of the list
  Buffer<std::uint32_t> group_base;  ///< by group: the first slot; then the end of the last group
  /// Slot-major: slot s of pixel p of a group is at (base + s) * 16 + p. A slot is key bits << 32 | ~number of the
  /// fragment, in descending order; 0 is empty.
  Buffer<std::uint64_t> slots;
  std::vector<std::uint64_t> run;    ///< equal keys of one pixel
  Buffer<std::uint32_t> references;  ///< covered (triangle, pixel) pairs of one batch

  [[nodiscard]] std::size_t length(std::size_t group) const { return group_base[group + 1] - group_base[group]; }
  /// The nearest and the farthest key of a fragment within its pixel.
  [[nodiscard]] float nearest_of(std::size_t number) const {
    const std::size_t t = arrived.triangle[number];
    return std::min(arrived.key_of(number) + triangles.half[t], triangles.high[t]);
  }
  [[nodiscard]] float farthest_of(std::size_t number) const {
    const std::size_t t = arrived.triangle[number];
    return std::max(arrived.key_of(number) - triangles.half[t], triangles.low[t]);
  }
  [[nodiscard]] std::uint64_t* slot(std::size_t group, std::size_t s) {
    return slots.data() + (group_base[group] + s) * kGroup;
  }
  [[nodiscard]] const std::uint64_t* slot(std::size_t group, std::size_t s) const {
    return slots.data() + (group_base[group] + s) * kGroup;
  }
};

/// Positions of a pixel's sub-samples, from its top left corner. Every pattern lies on multiples of 1/16 pixel, so edge
/// functions may be shifted right by 4 before stepping from sample to sample. The shift is exact, and a step is a
/// multiple of dx or -dy.
struct SamplePattern {
  static constexpr int max_count = 64;
  static constexpr int unit = 16;  ///< 1/256 pixels in 1/16 pixel

  int count = 1;
  std::array<std::int32_t, max_count> x{}, y{};  ///< in 1/16 pixel
  std::int32_t low_x = 0, high_x = 0, low_y = 0, high_y = 0;

  [[nodiscard]] std::uint64_t full() const {
    return count == max_count ? ~std::uint64_t(0) : (std::uint64_t(1) << count) - 1;
  }
  /// Positions in 1/256 pixel.
  [[nodiscard]] std::vector<glm::ivec2> positions() const;
};

/// Returns the pattern of a grid of grid x grid samples, or of the view's own samples if `grid` is 0. \throws Error
/// bad_argument unless the grid is 0, 2, 4 or 8.
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

/// Fills the scratch with all fragments of the rectangle, in the order of arrival. \returns `too_much` if there are
/// more than kMostOfTile; in rectangles of one pixel, all fragments are gathered. \throws Error limit_exceeded for more
/// than kMostOfPixel in one pixel.
[[nodiscard]] Gathered gather_tile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch);

/// Sorts gathered fragments into lists. Call once. O(n log^2 n) for lists of n fragments.
void sort_lists(Isa isa, GatherScratch& scratch);

/// Takes sub-samples that look through holes out of the masks. A mask may become 0; its fragment then shows nothing.
/// `pixels` is the rectangle that was gathered. O(fragments), or nothing if the scene has no cutouts.
void cut_fragments(const GatherInput& frame, const Rectangle& pixels, GatherScratch& scratch);

}  // namespace frontmost::abuffer_detail
