// SPDX-License-Identifier: Apache-2.0
// The holes of a cut-out triangle as a view sees them: asked at samples, answered alike to every method.
#pragma once

#include "surfaces/cutouts.h"
#include "view/ray_volumes.h"

namespace frontmost {

class ScreenCutout {
 public:
  /// Borrows the triangle.
  ScreenCutout(const CutoutTriangle& triangle, const ScreenRays& rays);
  /// Whether the ray through a place on the screen, in 1/256 pixel from the image's top left corner, passes. Places
  /// outside of the triangle count as the nearest on its rim, roughly: snapping moves corners by half of that unit.
  [[nodiscard]] bool is_hole(std::int32_t x, std::int32_t y) const;

 private:
  const CutoutTriangle* triangle_;
  RayVolumes volumes_;  ///< from the image's top left corner
};

}  // namespace frontmost
