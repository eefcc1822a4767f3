// SPDX-License-Identifier: Apache-2.0
// Rays in doubles, and where they meet a curved primitive.
#pragma once

#include <glm/glm.hpp>

#include "frontmost/view.h"

namespace frontmost::raycast_detail {

/// Points origin + t * direction, of which those with from <= t <= to count.
struct DoubleRay {
  glm::dvec3 origin{0}, direction{0, 0, -1};
  double from = 0, to = std::numeric_limits<double>::infinity();
  Culling culling = Culling::none;

  /// Whether a surface with this outward normal is looked at. Edge-on counts as front.
  [[nodiscard]] bool keeps(const glm::dvec3& normal) const {
    const bool is_front = glm::dot(normal, direction) <= 0;
    return culling == Culling::none || (culling == Culling::back && is_front) ||
           (culling == Culling::front && !is_front);
  }
};

struct RayMeeting {
  double t = 0;
  glm::dvec2 parameters{0};
  glm::dvec3 normal{0};  ///< world space, unit length, outwards
};

}  // namespace frontmost::raycast_detail
