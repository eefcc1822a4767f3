// SPDX-License-Identifier: Apache-2.0
#include "shade/tile.h"

#include <algorithm>
#include <bit>

#include "base/prefetch.h"

namespace frontmost::shading {

void TileWork::begin(const ShadedLayer& layer, const Colorist& colorist) {
  visible_ = &layer.visible;
  samples_ = layer.use == SampleUse::first ? 1 : layer.visible.view.samples;
  const auto all = sample_offsets(layer.visible.view.samples);
  centre_ = glm::vec2(0);
  for (std::size_t s = 0; s < std::size_t(samples_); ++s) {
    offsets_[s] = glm::vec2(all[s]) / 256.0f;
    centre_ += offsets_[s] / float(samples_);
  }
  fragments_.begin(layer.source, colorist);
}

bool TileWork::shade(const TileRectangle& tile) {
  fragments_.clear();
  bool anything = false;
  for (int y = 0; y < tile.height; ++y)
    anything = find_seen(visible_->index(tile.x, tile.y + y), tile.width, y) || anything;
  if (!anything) return false;
  // Most of a picture is background: nothing is cleared before something is found.
  std::fill(pixels_.begin(), pixels_.end(), glm::vec4(0));
  // Column by column: what is shaded at once then lies together on the surface, as rays that are cast at once should.
  constexpr int column = 4;
  for (int left = 0; left < tile.width; left += column)
    for (int y = 0; y < tile.height; ++y)
      for (int x = left; x < std::min(left + column, tile.width); ++x)
        if (seen_[y][x]) add_pixel(tile.x + x, tile.y + y, std::uint32_t(y * tile.width + x));
  flush();
  return true;
}

void TileWork::fade(float opacity) {
  for (glm::vec4& pixel : pixels_) pixel *= opacity;
}

bool TileWork::find_seen(std::size_t row, int width, int y) {
  PrimitiveId ids[tile_width];
  std::fill(std::begin(ids), std::end(ids), no_primitive);
  for (int s = 0; s < samples_; ++s) {
    const PrimitiveId* plane = visible_->primitives.data() + row + std::size_t(s) * visible_->view.pixel_count();
    // The same row of the next tile: steps of a row are too long for the processor to foresee.
    constexpr int line = 64 / sizeof(PrimitiveId);
    for (int x = 0; x < tile_width; x += line) prefetch_line(plane + tile_width + x);
    for (int x = 0; x < width; ++x) ids[x] &= plane[x];
  }
  PrimitiveId all = no_primitive;
  for (int x = 0; x < width; ++x) {
    all &= ids[x];
    seen_[y][x] = ids[x] != no_primitive;
  }
  return all != no_primitive;
}

void TileWork::add_pixel(int x, int y, std::uint32_t pixel) {
  PrimitiveId ids[16];
  bool same = true;
  for (int s = 0; s < samples_; ++s) {
    ids[s] = visible_->primitives[visible_->index(x, y, s)];
    same = same && ids[s] == ids[0];
  }
  const glm::vec2 corner{float(x), float(y)};
  if (same) {
    add_fragment(ids[0], pixel, corner + centre_, (1u << samples_) - 1);
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
    unsigned own = 0;
    for (int other = s; other < samples_; ++other)
      if (ids[other] == ids[s]) {
        sum += offsets_[std::size_t(other)];
        ++count;
        own |= 1u << other;
      }
    done |= own;
    add_fragment(ids[s], pixel, corner + sum / float(count), own);
  }
}

void TileWork::add_fragment(PrimitiveId id, std::uint32_t pixel, const glm::vec2& screen, unsigned samples) {
  if (fragments_.is_full()) flush();
  fragments_.add(id, pixel, screen, samples, float(std::popcount(samples)) / float(samples_));
}

void TileWork::flush() {
  // In the order of arrival, which is that of samples: sums of a pixel do not depend on its neighbours.
  fragments_.hand_out([this](std::uint32_t pixel, float weight, const glm::vec3& light, float alpha) {
    pixels_[pixel] += glm::vec4(light * (weight * alpha), weight * alpha);
  });
}

}  // namespace frontmost::shading
