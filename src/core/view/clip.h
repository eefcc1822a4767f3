// SPDX-License-Identifier: Apache-2.0
// Clipping of triangles that cannot be snapped whole.
//
//   - - - - - - - - - - - - - - - - - - - -
//   |        .-'|                         |      guard band: 8192 pixels from the middle of the image. A triangle
//   |     .-'   |  +-----------+          |      that leaves only the image is not clipped, but drawn where it
//   |   -'------+--|   image   |          |      lies within the image.
//   |              +-----------+          |
//   - - - - - - - - - - - - - - - - - - - -
//
// So only two kinds of triangles are clipped, and both are rare: those that reach over the guard band, and those that
// cross the near or the far plane. Without clipping, the divide by the distance would turn triangles that reach behind
// the eye inside out.
#pragma once

#include <array>
#include <span>

#include "view/screen_transform.h"

namespace frontmost {

/// The part of a triangle between near and far and within the guard band: a convex polygon, corners in the triangle's
/// order. A polygon of more than three corners begins with its topmost corner. Six planes leave at most nine corners.
struct ClippedPolygon {
  static constexpr int max_corners = 9;
  std::array<ScreenVertex, max_corners> corners;
  int count = 0;  ///< 0, or 3 to 9
};

/// Clips a triangle. Precondition: finite vertices. Neighbouring triangles are cut at the same points, to the bit:
/// every edge is cut from its inner to its outer end, in the same order of planes, and the cut lies on the plane
/// exactly.
[[nodiscard]] ClippedPolygon clip_triangle(const ScreenTransform& t, const std::array<glm::vec3, 3>& world);

}  // namespace frontmost
