// SPDX-License-Identifier: Apache-2.0
#include "shade/tile.h"

#include <algorithm>

namespace frontmost::shading {

TriangleCache::Found TriangleCache::find_or_add(PrimitiveId id) {
  std::uint32_t slot = id * 0x9E3779B1u >> 21;  // 11 bits: slot_count
  while (slots_[slot].generation == generation_) {
    if (slots_[slot].id == id) return {slots_[slot].number, false};
    slot = (slot + 1) % slot_count;
  }
  slots_[slot] = {generation_, id, std::uint16_t(count_++)};
  return {slots_[slot].number, true};
}

TileWork::TileWork(const TriangleSource& source, const Visible& visible, SampleUse use, const Colorist& colorist)
    : source_(source),
      visible_(visible),
      colorist_(colorist),
      samples_(use == SampleUse::first ? 1 : visible.view.samples),
      pixels_(tile_pixels),
      see_through_(tile_pixels, glm::vec2(0)) {
  const auto all = sample_offsets(visible.view.samples);
  for (int s = 0; s < samples_; ++s) offsets_.push_back(glm::vec2(all[std::size_t(s)]) / 256.0f);
  for (const glm::vec2& offset : offsets_) centre_ += offset / float(samples_);
}

bool TileWork::shade(const TileRectangle& tile) {
  cache_.clear();
  if (is_see_through_) std::fill(see_through_.begin(), see_through_.end(), glm::vec2(0));
  is_see_through_ = false;
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
  Coverage& coverage = arrived_;
  if (coverage.count == batch_capacity) flush();
  if (cache_.is_full()) {
    flush();
    cache_.clear();
  }
  const TriangleCache::Found found = cache_.find_or_add(id);
  if (found.is_new) new_triangles_.push_back({id, found.number, screen});
  const int i = coverage.count++;
  coverage.pixel[i] = pixel;
  coverage.triangle[i] = found.number;
  coverage.weight[i] = weight;
  coverage.screen.set(i, screen);
}

void TileWork::sort_by_triangle() {
  // Fragments arrive pixel by pixel. What belongs to a triangle is read once for each run of its fragments.
  std::uint16_t next[TriangleCache::capacity + 1] = {};
  for (int i = 0; i < arrived_.count; ++i) ++next[arrived_.triangle[i] + 1];
  for (int t = 0; t < TriangleCache::capacity; ++t) next[t + 1] = std::uint16_t(next[t + 1] + next[t]);
  Coverage& sorted = batch_.coverage;
  sorted.count = arrived_.count;
  for (int i = 0; i < arrived_.count; ++i) {
    const std::uint16_t place = place_[i] = next[arrived_.triangle[i]]++;
    sorted.pixel[place] = arrived_.pixel[i];
    sorted.triangle[place] = arrived_.triangle[i];
    sorted.weight[place] = arrived_.weight[i];
    sorted.screen.set(place, arrived_.screen.at(i));
  }
}

void TileWork::flush() {
  if (arrived_.count == 0) return;
  source_.set_up(new_triangles_, cache_.setups());
  new_triangles_.clear();
  sort_by_triangle();
  interpolate_geometry(source_.rays(), cache_.setups(), batch_);
  colorist_(cache_.setups(), batch_);
  // In the order of arrival, which is that of samples: sums of a pixel do not depend on its neighbours.
  for (int k = 0; k < arrived_.count; ++k) {
    const int i = place_[k];
    const std::uint32_t pixel = arrived_.pixel[k];
    const float weight = arrived_.weight[k], alpha = weight * batch_.material.alpha[i];
    pixels_[pixel] += glm::vec4(batch_.light.at(i) * alpha, alpha);
    if (batch_.material.see_through[i] > 0) {
      see_through_[pixel] += glm::vec2(weight, weight - alpha);
      is_see_through_ = true;
    }
  }
  arrived_.count = 0;
}

void TileWork::put_behind(const TileWork& layer) {
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const glm::vec2& part = see_through_[i];
    if (part.y > 0) pixels_[i] += layer.pixels_[i] * (part.y / part.x);
  }
}

}  // namespace frontmost::shading
