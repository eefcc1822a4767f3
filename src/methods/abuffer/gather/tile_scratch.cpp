// SPDX-License-Identifier: Apache-2.0
// Buffers at least double when they grow and never shrink, so nothing is allocated after the first tiles. Their bound
// is the number of fragments at which a tile is returned, not a buffer size. Fragment 0 stands for none, so that empty
// slots may be read like others.
#include "abuffer/gather/tile_scratch.h"

#include <algorithm>

namespace frontmost::abuffer_detail {
namespace {

template <class T>
void enlarge(Buffer<T>& buffer, std::size_t used, std::size_t size) {
  Buffer<T> larger(size);
  std::copy_n(buffer.data(), used, larger.data());
  buffer.swap(larger);
}

}  // namespace

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
    // Every pixel of the largest walk for every lane, and a vector of slack for whole stores.
    : counts(kTilePixels), group_base(kGroups + 1), references(16 * 16 * 16 + 64) {
  arrived.grow(kMostOfTile + kMostAtOnce);
  arrived.count = Arrived::first;
  // Empty slots are gathered from like fragments, so number 0 must be readable.
  arrived.key[0] = arrived.triangle[0] = arrived.place[0] = arrived.mask_low[0] = arrived.mask_high[0] = 0;
}

}  // namespace frontmost::abuffer_detail
