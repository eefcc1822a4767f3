// SPDX-License-Identifier: Apache-2.0
// The holes of a cutout triangle in a view: tested at samples, with the same answer for every method.
//
//   place on the screen --RayVolumes--> weights of the three vertices --texture--> alpha: a hole if below the cutoff
//
// The weights come from the ray through the place, not from snapped vertices. So the z-buffer, which snaps, and the ray
// caster, which does not, read the same texel.
#pragma once

#include "surfaces/cutouts.h"
#include "view/ray_volumes.h"
#include "view/screen_transform.h"

namespace frontmost {

class ScreenCutout {
 public:
  /// Borrows the triangle.
  ScreenCutout(const CutoutTriangle& triangle, const ScreenRays& rays) : triangle_(&triangle) {
    const auto corner = [&](std::size_t k) { return glm::dvec3(triangle.corner[k]) - rays.eye(); };
    volumes_ = ray_volumes(rays, {corner(0), corner(1), corner(2)}, 0, 0);
  }
  /// Whether the ray through a place on the screen, in 1/256 pixel from the image's top left, passes through a hole. A
  /// place outside of the triangle counts roughly as the nearest place on its rim: snapping moves vertices by half of
  /// that unit.
  [[nodiscard]] bool is_hole(std::int32_t x, std::int32_t y) const {
    // Always computed from the same corner, never by steps from the sample before: the answer depends on the place
    // alone, not on the order of calls.
    constexpr double kPixel = 1.0 / kSubPixels;
    const glm::dvec3 at =
        volumes_.value + (double(x) * kPixel) * volumes_.step_x + (double(y) * kPixel) * volumes_.step_y;
    return triangle_->is_hole(normalized_weights(at));
  }

 private:
  const CutoutTriangle* triangle_;
  RayVolumes volumes_;  ///< at the image's top left corner
};

}  // namespace frontmost
