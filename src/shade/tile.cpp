// SPDX-License-Identifier: Apache-2.0
#include "shade/tile.h"

#include <algorithm>

namespace frontmost::shading {

TileWork::TileWork(const TriangleSource& source, const Visible& visible, SampleUse use, const Colorist& colorist)
    : visible_(visible),
      samples_(use == SampleUse::first ? 1 : visible.view.samples),
      fragments_(source, colorist),
      pixels_(tile_pixels) {
  const auto all = sample_offsets(visible.view.samples);
  for (int s = 0; s < samples_; ++s) offsets_.push_back(glm::vec2(all[std::size_t(s)]) / 256.0f);
  for (const glm::vec2& offset : offsets_) centre_ += offset / float(samples_);
}

bool TileWork::shade(const TileRectangle& tile) {
  fragments_.clear();
  bool anything = false;
  for (int y = 0; y < tile.height; ++y) {
    const std::size_t row = visible_.index(tile.x, tile.y + y);
    if (!find_seen(row, tile.width)) continue;
    // Most of a picture is background: nothing is cleared before something is found.
    if (!anything) std::fill(pixels_.begin(), pixels_.end(), glm::vec4(0));
    anything = true;
    for (int x = 0; x < tile.width; ++x)
      if (seen_[x]) add_pixel(tile.x + x, tile.y + y, std::uint32_t(y * tile.width + x));
  }
  flush();
  return anything;
}

bool TileWork::find_seen(std::size_t row, int width) {
  PrimitiveId ids[tile_width];
  std::fill(std::begin(ids), std::end(ids), no_primitive);
  for (int s = 0; s < samples_; ++s) {
    const PrimitiveId* plane = visible_.primitives.data() + row + std::size_t(s) * visible_.view.pixel_count();
    // The same row of the next tile: steps of a row are too long for the processor to foresee.
    constexpr int line = 64 / sizeof(PrimitiveId);
    for (int x = 0; x < tile_width; x += line) __builtin_prefetch(plane + tile_width + x);
    for (int x = 0; x < width; ++x) ids[x] &= plane[x];
  }
  PrimitiveId all = no_primitive;
  for (int x = 0; x < width; ++x) {
    all &= ids[x];
    seen_[x] = ids[x] != no_primitive;
  }
  return all != no_primitive;
}

void TileWork::add_pixel(int x, int y, std::uint32_t pixel) {
  PrimitiveId ids[16];
  bool same = true;
  for (int s = 0; s < samples_; ++s) {
    ids[s] = visible_.primitives[visible_.index(x, y, s)];
    same = same && ids[s] == ids[0];
  }
  const glm::vec2 corner{float(x), float(y)};
  if (same) {
    add_fragment(ids[0], pixel, corner + centre_, 1.0f);
  } else {
    add_mixed_pixel(ids, corner, pixel);
  }
}

void TileWork::add_mixed_pixel(const PrimitiveId* ids, const glm::vec2& corner, std::uint32_t pixel) {
  unsigned done = 0;
  for (int s = 0; s < samples_; ++s) {
    if (ids[s] == no_primitive || (done >> s) & 1) continue;
    glm::vec2 sum(0);
    int count = 0;
    for (int other = s; other < samples_; ++other)
      if (ids[other] == ids[s]) {
        sum += offsets_[std::size_t(other)];
        ++count;
        done |= 1u << other;
      }
    add_fragment(ids[s], pixel, corner + sum / float(count), float(count) / float(samples_));
  }
}

void TileWork::add_fragment(PrimitiveId id, std::uint32_t pixel, const glm::vec2& screen, float weight) {
  if (fragments_.is_full()) flush();
  fragments_.add(id, pixel, screen, weight);
}

void TileWork::flush() {
  // In the order of arrival, which is that of samples: sums of a pixel do not depend on its neighbours.
  fragments_.hand_out([this](std::uint32_t pixel, float weight, const glm::vec3& light, float alpha) {
    pixels_[pixel] += glm::vec4(light * (weight * alpha), weight * alpha);
  });
}

}  // namespace frontmost::shading
