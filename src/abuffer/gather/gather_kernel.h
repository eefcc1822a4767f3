// SPDX-License-Identifier: Apache-2.0
// Gathering the fragments of one tile.
#pragma once

#include "abuffer/gather/tile_scratch.h"
#include "abuffer/plan/crowd.h"

namespace frontmost::abuffer_detail {

/// What all tiles of a frame share.
struct GatherInput {
  const FragmentPlan& plan;
  const SamplePattern& pattern;
  /// Lists hold primitive ids instead of numbers of fragments, and fragments know neither triangle nor mask: quicker,
  /// and enough where a pixel has one sample. Only with one sample.
  bool is_flat;
  Isa isa;
  /// What may be left out where tiles hold too much.
  const CopyRule& copies;
  /// By primitive, where it is known; asked for ahead while triangles are drawn.
  const glm::vec4* colors = nullptr;
};

/// A rectangle of a tile, whose clusters and single triangles it looks through.
struct GatherJob {
  Rectangle pixels;
  std::size_t tile;
};

enum class Gathered : std::uint8_t { nothing, something, too_much };

/// Fills the scratch's sorted lists with all fragments of the rectangle. `too_much`: they are more than kMostOfTile;
/// of rectangles of one pixel all are gathered. \throws Error limit_exceeded for more than kMostOfPixel in one pixel.
[[nodiscard]] Gathered gather_tile(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch);

}  // namespace frontmost::abuffer_detail
