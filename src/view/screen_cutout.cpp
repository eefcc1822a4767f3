// SPDX-License-Identifier: Apache-2.0
#include "view/screen_cutout.h"

#include "view/screen_transform.h"

namespace frontmost {
namespace {

std::array<glm::dvec3, 3> from_eye(const CutoutTriangle& triangle, const ScreenRays& rays) {
  const auto corner = [&](std::size_t k) { return glm::dvec3(triangle.corner[k]) - rays.eye(); };
  return {corner(0), corner(1), corner(2)};
}

}  // namespace

ScreenCutout::ScreenCutout(const CutoutTriangle& triangle, const ScreenRays& rays)
    : triangle_(&triangle), volumes_(ray_volumes(rays, from_eye(triangle, rays), 0, 0)) {}

bool ScreenCutout::is_hole(std::int32_t x, std::int32_t y) const {
  // From the same corner each time, never by steps from the sample before: the answer is that of the place alone,
  // whoever asks in whatever order.
  constexpr double kPixel = 1.0 / kSubPixels;
  const glm::dvec3 at =
      volumes_.value + (double(x) * kPixel) * volumes_.step_x + (double(y) * kPixel) * volumes_.step_y;
  return triangle_->is_hole(normalized_weights(at));
}

}  // namespace frontmost
