// SPDX-License-Identifier: Apache-2.0
#include "shade/environment/octahedral_map.h"

#include <algorithm>
#include <cmath>

namespace frontmost::shading {
namespace {

float signed_as(float value, float sign) { return sign < 0 ? -value : value; }

}  // namespace

glm::vec3 octahedron_point(float u, float v) {
  const float x = 2 * u - 1, z = 2 * v - 1, y = 1 - std::abs(x) - std::abs(z);
  if (y >= 0) return {x, y, z};
  return {signed_as(1 - std::abs(z), x), y, signed_as(1 - std::abs(x), z)};
}

float solid_angle(const glm::vec3& octahedron_point) {
  // All faces are equally far from the centre and at one angle to the square, so only 1 / length^3 varies.
  const float squared = glm::dot(octahedron_point, octahedron_point);
  return 1.0f / (squared * std::sqrt(squared));
}

glm::vec3 OctahedralMap::color(const glm::vec3& towards) const {
  const float scale = 1.0f / (std::abs(towards.x) + std::abs(towards.y) + std::abs(towards.z));
  glm::vec2 at(towards.x * scale, towards.z * scale);
  if (towards.y < 0) at = {signed_as(1 - std::abs(at.y), towards.x), signed_as(1 - std::abs(at.x), towards.z)};
  const glm::vec2 place = (at * 0.5f + 0.5f) * float(size_) - 0.5f;
  // NaN gives the first texel.
  const glm::vec2 first = glm::min(glm::max(glm::vec2(-1), glm::floor(place)), glm::vec2(float(size_ - 1)));
  const glm::vec2 part = place - first;
  const int x = int(first.x), y = int(first.y);
  const glm::vec3 upper = color(x, y) + (color(x + 1, y) - color(x, y)) * part.x;
  const glm::vec3 lower = color(x, y + 1) + (color(x + 1, y + 1) - color(x, y + 1)) * part.x;
  return upper + (lower - upper) * part.y;
}

void OctahedralMap::close_border() {
  const int last = size_ - 1;
  for (int i = 0; i < size_; ++i) {
    set(i, -1, color(last - i, 0));
    set(i, size_, color(last - i, last));
    set(-1, i, color(0, last - i));
    set(size_, i, color(last, last - i));
  }
  for (const int x : {-1, size_})
    for (const int y : {-1, size_}) set(x, y, color(x < 0 ? last : 0, y < 0 ? last : 0));
}

OctahedralMap OctahedralMap::half() const {
  OctahedralMap coarse(size_ / 2);
  for (int y = 0; y < coarse.size_; ++y)
    for (int x = 0; x < coarse.size_; ++x) {
      glm::vec3 sum(0);
      float weights = 0;
      for (int k = 0; k < 4; ++k) {
        const int fine_x = 2 * x + k % 2, fine_y = 2 * y + k / 2;
        const float weight = solid_angle(octahedron_point(size_, fine_x, fine_y));
        sum += weight * color(fine_x, fine_y);
        weights += weight;
      }
      coarse.set(x, y, sum / weights);
    }
  coarse.close_border();
  return coarse;
}

}  // namespace frontmost::shading
