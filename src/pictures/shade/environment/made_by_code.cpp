// SPDX-License-Identifier: Apache-2.0
// Environments without files: the studio, and a sky.

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "shade/environment/prefiltered.h"

namespace frontmost::shading {
namespace {

/// A smooth step from 0 to 1 as t goes from 0 to 1, with slope 0 at both ends.
float eased(float t) {
  const float inside = std::clamp(t, 0.0f, 1.0f);
  return inside * inside * (3 - 2 * inside);
}

/// A lamp behind a rectangle of cloth, as photographers use around a product.
class SoftBox {
 public:
  /// `middle`: direction of its middle; `extent`: half width and height as tangents; `softness`: width of its fading
  /// rim.
  SoftBox(const glm::vec3& middle, const glm::vec2& extent, float softness, float radiance)
      : ahead_(glm::normalize(middle)),
        right_(glm::normalize(std::abs(ahead_.y) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(ahead_.z, 0, -ahead_.x))),
        up_(glm::cross(ahead_, right_)),
        extent_(extent),
        softness_(softness),
        radiance_(radiance) {}

  /// The radiance towards a direction, with the box in front of `light`.
  [[nodiscard]] float before(float light, const glm::vec3& towards) const {
    const float distance = glm::dot(towards, ahead_);
    if (distance <= 0) return light;
    const float across = extent_.x - std::abs(glm::dot(towards, right_)) / distance;
    const float along = extent_.y - std::abs(glm::dot(towards, up_)) / distance;
    return light + (radiance_ - light) * eased(across / softness_) * eased(along / softness_);
  }

 private:
  glm::vec3 ahead_, right_, up_;
  glm::vec2 extent_;
  float softness_, radiance_;
};

/// In order: beside the key light; one at each side, for the outlines of bottles and pipes; overhead; and a large dim
/// one behind the camera, for surfaces that face it.
const std::array<SoftBox, 5>& soft_boxes() {
  static const std::array<SoftBox, 5> boxes{{{{-0.48f, 0.68f, 0.72f}, {0.40f, 0.40f}, 0.14f, 1.25f},
                                             {{0.95f, 0.12f, 0.30f}, {0.20f, 0.85f}, 0.09f, 1.1f},
                                             {{-0.92f, 0.10f, -0.38f}, {0.16f, 0.85f}, 0.09f, 1.1f},
                                             {{0.10f, 1.0f, -0.25f}, {0.45f, 0.32f}, 0.14f, 0.7f},
                                             {{0.20f, 0.05f, 1.0f}, {0.45f, 0.40f}, 0.20f, 0.40f}}};
  return boxes;
}

}  // namespace

glm::vec3 studio_radiance(const glm::vec3& towards) {
  float light = 0.115f + 0.075f * eased(0.5f + 0.55f * towards.y);
  for (const SoftBox& box : soft_boxes()) light = box.before(light, towards);
  return glm::vec3(light);
}

glm::vec3 sky_radiance(const glm::vec3& towards) {
  constexpr glm::vec3 zenith(0.16f, 0.26f, 0.48f), horizon(0.52f, 0.56f, 0.60f), ground(0.14f, 0.13f, 0.115f);
  const float below = eased(0.5f - 10 * towards.y);  // the horizon is a few degrees wide
  const float height = std::sqrt(std::max(towards.y, 0.0f));
  const glm::vec3 sky = horizon + (zenith - horizon) * height;
  return sky + (ground - sky) * below;
}

OctahedralMap draw_map(int size, const Radiance& radiance, const Execution& execution) {
  OctahedralMap map(size);
  constexpr std::size_t rows_at_once = 8;
  parallel_for(execution, std::size_t(size), rows_at_once, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < size; ++x) map.set(x, y, radiance(glm::normalize(octahedron_point(size, x, y))));
  });
  map.close_border();
  return map;
}

}  // namespace frontmost::shading
