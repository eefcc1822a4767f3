// SPDX-License-Identifier: Apache-2.0
#include "shade/fragment_shader.h"

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

void FragmentShader::add(PrimitiveId id, std::uint32_t number, const glm::vec2& screen, std::uint64_t samples,
                         float weight) {
  const TriangleCache::Found found = cache_.find_or_add(id);
  if (found.is_new) new_triangles_.push_back({id, found.number, screen});
  const int i = arrived_.count++;
  arrived_.pixel[i] = number;
  arrived_.triangle[i] = found.number;
  arrived_.samples[i] = samples;
  arrived_.weight[i] = weight;
  arrived_.screen.set(i, screen);
}

void FragmentShader::sort_by_triangle() {
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
    sorted.samples[place] = arrived_.samples[i];
    sorted.weight[place] = arrived_.weight[i];
    sorted.screen.set(place, arrived_.screen.at(i));
  }
}

void FragmentShader::shade_arrived() {
  source_->set_up(new_triangles_, cache_.setups());
  new_triangles_.clear();
  sort_by_triangle();
  interpolate_geometry(source_->rays(), cache_.setups(), batch_);
  (*colorist_)(cache_.setups(), batch_);
}

}  // namespace frontmost::shading
