// SPDX-License-Identifier: Apache-2.0
#include "cli/render/fit.h"

#include <algorithm>
#include <cmath>

namespace frontmost::cli {
namespace {

constexpr double usable_part = 0.9;  // FrameOptions::margin on each side

/// Corner of the box seen from `target` in the eye's axes: right, up, forward.
glm::dvec3 corner(const Box& box, int number, const glm::dvec3& target, const View& view) {
  const glm::dvec3 point(number & 1 ? box.high.x : box.low.x, number & 2 ? box.high.y : box.low.y,
                         number & 4 ? box.high.z : box.low.z);
  const glm::dvec3 offset = point - target;
  return {glm::dot(offset, view.right()), glm::dot(offset, view.up()), glm::dot(offset, view.forward())};
}

}  // namespace

FitBounds visible_bounds(const Surfaces& surfaces) {
  Box box = surfaces.bounds();
  if (box.is_empty()) box = {glm::vec3(-0.5f), glm::vec3(0.5f)};
  if (!(box.diagonal() > 0)) {
    const float reach = std::max(0.5f, 1e-3f * glm::length(box.low));
    box = {box.low - reach, box.low + reach};
  }
  return {box, glm::dvec3(box.low) + (glm::dvec3(box.high) - glm::dvec3(box.low)) * 0.5, double(box.diagonal())};
}

// With the middle of the picture at slopes m, and its half sides h: the eye at distance d stands at
// target - d (forward + m), where the target is in the middle; a corner (x, z) is then at slope
// (x + m d) / (d + z), which is within h of m exactly when d >= |x - m z| / h - z.
void fit(View& view, const glm::dvec3& target, const FitBounds& bounds) {
  Projection& p = view.projection;
  const glm::dvec2 middle((p.left + p.right) * 0.5, (p.bottom + p.top) * 0.5);
  const glm::dvec2 half((p.right - p.left) * 0.5 * usable_part, (p.top - p.bottom) * 0.5 * usable_part);
  double distance = bounds.diagonal * 1e-3, widening = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 c = corner(bounds.box, i, target, view);
    for (int side = 0; side < 2; ++side) {
      distance = std::max(distance, std::abs(c[side] - middle[side] * c.z) / half[side] - c.z);
      widening = std::max(widening, std::abs(c[side]) / half[side]);
    }
  }
  if (p.orthographic) {
    for (double* const side : {&p.left, &p.right, &p.bottom, &p.top}) *side *= widening;
    distance = bounds.diagonal + glm::distance(target, bounds.centre);
  }
  const glm::dvec2 shift = p.orthographic ? glm::dvec2(0.0) : middle;
  const glm::dvec3 eye = target - distance * (view.forward() + shift.x * view.right() + shift.y * view.up());
  view.world_from_eye[3] = glm::dvec4(eye, 1);
}

}  // namespace frontmost::cli
