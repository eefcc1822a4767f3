// SPDX-License-Identifier: Apache-2.0
#include "zbuffer/tile/tile.h"

namespace frontmost::zbuffer_detail {

// References: every pixel of the largest walk for every lane, and a vector of slack for whole stores.
TileScratch::TileScratch() : bounds(1), references(std::size_t(16 * kMostWalked.x * kMostWalked.y) + 64) {}

void TileScratch::reserve(std::size_t sample_count) {
  if (words.size() < sample_count * kTileWords) words = Buffer<std::uint64_t>(sample_count * kTileWords);
}

}  // namespace frontmost::zbuffer_detail
