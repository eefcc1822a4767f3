// SPDX-License-Identifier: Apache-2.0
#include "shade/shadow/shadow_map.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace frontmost::shading {
namespace {

struct KeyRange {
  float least, greatest;
};

/// Replaces each number of a square by the least or greatest (`choose`) of itself and the two after it along both axes.
template <class Choose>
void spread(float* numbers, std::size_t size, const Choose& choose) {
  static_assert(ShadowGrid::window == 3 * ShadowGrid::block);
  for (std::size_t y = 0; y < size; ++y) {
    float* const row = numbers + y * size;
    for (std::size_t x = 0; x + 2 < size; ++x) row[x] = choose(row[x], choose(row[x + 1], row[x + 2]));
    row[size - 2] = choose(row[size - 2], row[size - 1]);
  }
  for (std::size_t y = 0; y < size; ++y)
    for (std::size_t next = y + 1; next < std::min(y + 3, size); ++next)
      for (std::size_t x = 0; x < size; ++x)
        numbers[y * size + x] = choose(numbers[y * size + x], numbers[next * size + x]);
}

/// The range of a block of keys whose rows are `size` apart.
KeyRange range_of_block(const float* keys, std::size_t size) {
  constexpr std::size_t block = ShadowGrid::block;
  float least[block], greatest[block];
  std::copy_n(keys, block, least);
  std::copy_n(keys, block, greatest);
  for (std::size_t j = 1; j < block; ++j)
    for (std::size_t i = 0; i < block; ++i) {
      const float key = keys[j * size + i];
      least[i] = std::min(least[i], key);
      greatest[i] = std::max(greatest[i], key);
    }
  return {*std::min_element(least, least + block), *std::max_element(greatest, greatest + block)};
}

}  // namespace

void ShadowMap::draw(const Visible& seen_by_light, const Execution& execution) {
  clear();  // after an error everything is lit
  light_ = seen_by_light.view;
  constexpr std::size_t block = ShadowGrid::block;
  const auto size = std::size_t(light_.width), blocks = size / block;
  for (Buffer<float>* keys_of_blocks : {&farthest_, &nearest_})
    if (keys_of_blocks->size() != blocks * blocks) *keys_of_blocks = Buffer<float>(blocks * blocks);
  const float* const keys = seen_by_light.keys.data();
  parallel_for(execution, blocks, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (std::size_t x = 0; x < blocks; ++x) {
        const KeyRange range = range_of_block(keys + y * block * size + x * block, size);
        farthest_[y * blocks + x] = range.least;
        nearest_[y * blocks + x] = range.greatest;
      }
  });
  spread(farthest_.data(), blocks, [](float a, float b) { return std::min(a, b); });
  spread(nearest_.data(), blocks, [](float a, float b) { return std::max(a, b); });
  grid_.keys = keys;
  grid_.farthest = farthest_.data();
  grid_.nearest = nearest_.data();
  grid_.size = light_.width;
}

void ShadowMap::measure_from(const glm::dvec3& eye) {
  grid_.is_spot = !light_.projection.orthographic;
  grid_.to_light = glm::vec3(glm::dvec3(light_.world_from_eye[2]));
  grid_.is_spot ? measure_spot(eye) : measure_sun(eye);
}

void ShadowMap::measure_sun(const glm::dvec3& eye) {
  const glm::dmat3 axes(light_.world_from_eye);
  const Projection& window = light_.projection;
  const double texel = (window.right - window.left) / light_.width, depth = window.clip.far - window.clip.near;
  grid_.texel_x = glm::vec3(axes[0] / texel);
  grid_.texel_y = glm::vec3(axes[1] * (-1 / texel));
  grid_.key = glm::vec3(axes[2] / depth);
  // The light's eye is before everything that it sees and has key 1.
  const glm::dvec3 from_light = eye - light_.eye();
  grid_.at_eye =
      glm::vec3((glm::dot(axes[0], from_light) - window.left) / texel,
                (window.top - glm::dot(axes[1], from_light)) / texel, 1 + glm::dot(axes[2], from_light) / depth);
  grid_.key_bias = float(0.75 * texel / depth + 2e-6);
  grid_.key_slope_bias = float((0.5 * ShadowGrid::taps + 1) * texel / depth);
}

void ShadowMap::measure_spot(const glm::dvec3& eye) {
  const glm::dmat3 axes(light_.world_from_eye);
  const Projection& window = light_.projection;
  const double texel = (window.right - window.left) / light_.width, per_near = 1 / window.clip.near;  // at a depth of 1
  const glm::dvec3 x = (axes[0] + axes[2] * window.left) * (per_near / texel);
  const glm::dvec3 y = (-axes[1] - axes[2] * window.top) * (per_near / texel), key = axes[2] * -per_near;
  const glm::dvec3 from_lamp = eye - light_.eye();
  grid_.texel_x = glm::vec3(x);
  grid_.texel_y = glm::vec3(y);
  grid_.key = glm::vec3(key);
  grid_.at_eye = glm::vec3(glm::dot(x, from_lamp), glm::dot(y, from_lamp), glm::dot(key, from_lamp));
  grid_.lamp = glm::vec3(-from_lamp);
  grid_.key_bias = float(0.75 * texel + 2e-6);
  grid_.key_slope_bias = float((0.5 * ShadowGrid::taps + 1) * texel);
}

}  // namespace frontmost::shading
