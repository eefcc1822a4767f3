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

namespace detail {
[[nodiscard]] inline std::array<glm::dvec3, 3> corners_from_eye(const CutoutTriangle& triangle,
                                                                const ScreenRays& rays) {
  const auto corner = [&](std::size_t k) { return glm::dvec3(triangle.corner[k]) - rays.eye(); };
  return {corner(0), corner(1), corner(2)};
}
}  // namespace detail

class ScreenCutout {
 public:
  /// Borrows the triangle.
  ScreenCutout(const CutoutTriangle& triangle, const ScreenRays& rays);
  /// Whether the ray through a place on the screen, in 1/256 pixel from the image's top left, passes through a hole.
  /// Snapping moves vertices by up to half of that unit, so the place may lie outside of the triangle; it then counts
  /// roughly as the nearest place on the triangle's rim.
  [[nodiscard]] bool is_hole(std::int32_t x, std::int32_t y) const;

 private:
  const CutoutTriangle* triangle_;
  RayVolumes volumes_;  ///< at the image's top left corner
};

inline ScreenCutout::ScreenCutout(const CutoutTriangle& triangle, const ScreenRays& rays)
    : triangle_(&triangle), volumes_(ray_volumes(rays, detail::corners_from_eye(triangle, rays), 0, 0)) {}

inline bool ScreenCutout::is_hole(std::int32_t x, std::int32_t y) const {
  // Always computed from the same corner, never by steps from the sample before: the answer depends on the place alone,
  // not on the order of calls.
  constexpr double kPixel = 1.0 / kSubPixels;
  const glm::dvec3 at =
      volumes_.value + (double(x) * kPixel) * volumes_.step_x + (double(y) * kPixel) * volumes_.step_y;
  return triangle_->is_hole(normalized_weights(at));
}

}  // namespace frontmost
