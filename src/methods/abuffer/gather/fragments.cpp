// SPDX-License-Identifier: Apache-2.0
// The parts of gathering that are not kernels: positions of sub-samples, memory for fragments, and holes in fragments.
//
// Buffers at least double when they grow and never shrink, so nothing is allocated after the first tiles. Holes are
// tested after sorting, in doubles and by the code that all methods share (view/screen_cutout.h), so only scenes with
// cutouts pay for them. A fragment whose mask becomes empty stays in its list: removing it would move all that follow.
#include <algorithm>
#include <bit>
#include <optional>
#include <string>

#include "abuffer/gather/gather_kernel.h"
#include "view/screen_cutout.h"

namespace frontmost::abuffer_detail {
namespace {

void add(SamplePattern& pattern, std::int32_t x, std::int32_t y) {
  const auto i = std::size_t(pattern.count++);
  pattern.x[i] = x;
  pattern.y[i] = y;
}

template <class T>
void enlarge(Buffer<T>& buffer, std::size_t used, std::size_t size) {
  Buffer<T> larger(size);
  std::copy_n(buffer.data(), used, larger.data());
  buffer.swap(larger);
}

/// A pixel's place in its tile: the inverse of pixel_number().
glm::ivec2 place_of(std::uint32_t pixel) {
  const int group = int(pixel / kGroup), lane = int(pixel % kGroup);
  return {group % kBlocksAcross * 4 + lane % 4, group / kBlocksAcross * 4 + lane / 4};
}

}  // namespace

std::vector<glm::ivec2> SamplePattern::positions() const {
  std::vector<glm::ivec2> result;
  for (std::size_t i = 0; i < std::size_t(count); ++i) result.push_back({x[i] * unit, y[i] * unit});
  return result;
}

SamplePattern sample_pattern(const View& view, int grid) {
  if (grid != 0 && grid != 2 && grid != 4 && grid != 8)
    throw Error(ErrorCode::bad_argument, "abuffer: grid", "must be 0, 2, 4 or 8, not " + std::to_string(grid));
  SamplePattern pattern;
  pattern.count = 0;
  if (grid == 0)
    for (const glm::ivec2& s : sample_offsets(view.samples))
      add(pattern, s.x / SamplePattern::unit, s.y / SamplePattern::unit);
  const int spacing = grid ? SamplePattern::unit / grid : 0;
  for (int y = 0; y < grid; ++y)
    for (int x = 0; x < grid; ++x) add(pattern, x * spacing + spacing / 2, y * spacing + spacing / 2);
  // The range of the samples in a pixel: a triangle that lies between the samples of neighbouring pixels touches no
  // pixel.
  const auto xs = std::minmax_element(pattern.x.begin(), pattern.x.begin() + pattern.count);
  const auto ys = std::minmax_element(pattern.y.begin(), pattern.y.begin() + pattern.count);
  pattern.low_x = *xs.first;
  pattern.high_x = *xs.second;
  pattern.low_y = *ys.first;
  pattern.high_y = *ys.second;
  return pattern;
}

void LocalTriangles::reserve(std::size_t more) {
  if (count + more <= id.size()) return;
  const std::size_t size = std::max<std::size_t>(2 * id.size(), count + more + 4096);
  for (Buffer<std::int32_t>* b : {&x0, &y0}) enlarge(*b, count, size);
  for (Buffer<float>* b : {&k0, &gx, &gy, &low, &high, &slack, &half}) enlarge(*b, count, size);
  for (Buffer<std::uint32_t>* b : {&steep, &id}) enlarge(*b, count, size);
}

void Arrived::grow(std::size_t wanted) {
  if (wanted <= capacity) return;
  const std::size_t size = std::max(wanted, 2 * capacity);
  for (Buffer<std::uint32_t>* b : {&key, &place, &triangle, &mask_low, &mask_high}) enlarge(*b, count, size);
  capacity = size;
}

GatherScratch::GatherScratch()
    // `references` has room for every pixel of the largest walk in every lane, and for one vector more, because stores
    // write whole vectors.
    : counts(kTilePixels), group_base(kGroups + 1), references(16 * 16 * 16 + 64) {
  arrived.grow(kMostOfTile + kMostAtOnce);
  arrived.count = Arrived::first;
  // Empty slots read number 0 as if it were a fragment, so it must be readable.
  arrived.key[0] = arrived.triangle[0] = arrived.place[0] = arrived.mask_low[0] = arrived.mask_high[0] = 0;
}

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
