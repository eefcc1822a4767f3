// SPDX-License-Identifier: Apache-2.0
// Holes in fragments: sub-samples that look through holes are taken out of the masks.
//
// Holes are tested after sorting, fragment by fragment and sample by sample, in doubles and by the code that all
// methods share (view/screen_cutout.h). Only scenes with cutouts pay for these tests, and the kernels that gather know
// nothing of textures. A fragment whose mask becomes empty stays in its list: removing it would move all that follow.

#include <bit>
#include <optional>

#include "abuffer/gather/gather_kernel.h"
#include "view/ray_volumes.h"
#include "view/screen_cutout.h"

namespace frontmost::abuffer_detail {
namespace {

/// A pixel's place in its tile: the inverse of pixel_number().
glm::ivec2 place_of(std::uint32_t pixel) {
  const int group = int(pixel / kGroup), lane = int(pixel % kGroup);
  return {group % kBlocksAcross * 4 + lane % 4, group / kBlocksAcross * 4 + lane / 4};
}

}  // namespace

void cut_fragments(const GatherInput& frame, const Rectangle& pixels, GatherScratch& scratch) {
  const Cutouts* const cutouts = frame.plan.set().cutouts.get();
  if (!cutouts) return;
  const ScreenRays rays(frame.plan.view());
  const std::vector<glm::ivec2> samples = frame.pattern.positions();
  std::optional<ScreenCutout> cutout;
  PrimitiveId last = no_primitive;
  Arrived& arrived = scratch.arrived;
  for (std::size_t i = Arrived::first; i < arrived.count; ++i) {
    const PrimitiveId id = scratch.triangles.id[arrived.triangle[i]];
    if (!cutouts->has(id)) continue;
    // Fragments arrive triangle by triangle, so the plane is set up once for all pixels of a triangle.
    if (id != last) cutout.emplace((*cutouts)[id], rays);
    last = id;
    const glm::ivec2 pixel = glm::ivec2(pixels.x, pixels.y) + place_of(arrived.place[i] >> kRankBits);
    std::uint64_t mask = arrived.mask(i);
    for (std::uint64_t left = mask; left != 0; left &= left - 1) {
      const glm::ivec2 at = pixel * kSubPixels + samples[std::size_t(std::countr_zero(left))];
      if (cutout->is_hole(at.x, at.y)) mask &= ~(left & -left);
    }
    arrived.mask_low[i] = std::uint32_t(mask);
    arrived.mask_high[i] = std::uint32_t(mask >> 32);
  }
}

}  // namespace frontmost::abuffer_detail
