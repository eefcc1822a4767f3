// SPDX-License-Identifier: Apache-2.0
// The triangles that a view may show, on its screen, and the sides at which a surface ends.
//
//       .-----.-----.         A side is plain (p) if exactly one other triangle lies beyond it, on its other side as
//      / \ p / \   / \        seen: the number of surfaces over a place does not change there. At all other sides
//     /   \ /   \ /   \       the number changes: at a contour (c), where the surface folds back, at a rim, and where
//    '-----'-----'-----'      the near plane cuts the surface.
//      c     c     c
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <vector>

#include "frontmost/report.h"
#include "geometry/edge_neighbours.h"

namespace frontmost::faces_detail {

/// Width in pixels, 2^-30. Narrower parts are not told apart from their neighbours. Doubles are exact to about 2^-38
/// pixel.
inline constexpr double kNarrow = 1.0 / (1 << 30);

/// A place in the picture, in pixels, and the key of a surface there. Keys are affine over the screen and greater for
/// nearer surfaces.
struct ScreenPoint {
  double x, y, key;
};

struct Range {
  double low, high;
};

[[nodiscard]] inline Range range_of(double a, double b, double c) { return {std::min({a, b, c}), std::max({a, b, c})}; }

/// A rectangle of the picture, in pixels.
struct CellBox {
  double left, top, right, bottom;
};

/// A triangle, or a part of a clipped one.
struct ViewedFace {
  std::uint32_t corners[3];  ///< numbers of points
  PrimitiveId id;
};

struct ViewedFaces {
  Buffer<ScreenPoint> points;   ///< vertices, by instance and number; then the points of clipped triangles
  Buffer<ViewedFace> faces;     ///< by id, ascending; the parts of one triangle are consecutive
  Buffer<std::uint8_t> ending;  ///< by face, bit k: a surface ends at side k, from corner k to the next
};

/// Twice the area, positive if the corners turn to the right as seen (y points down).
[[nodiscard]] inline double turn_of(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The triangles beyond the sides of the triangles of each mesh that has an instance. Vertices at one place count as
/// one, whatever their numbers. \throws Error limit_exceeded for more than EdgeNeighbours::most_triangles.
[[nodiscard]] std::vector<EdgeNeighbours> sides_of_meshes(const Scene& scene, const Execution& execution);

/// The faces that lie at least partly within the picture, between near and far, are wider than kNarrow and are not
/// culled. `sides` has an entry for each mesh.
[[nodiscard]] ViewedFaces viewed_faces(const Surfaces& surfaces, const View& view,
                                       const std::vector<EdgeNeighbours>& sides, const Execution& execution);

/// The visible faces by id, ascending. `sides` has an entry for each mesh. O(faces + cells in which surfaces end).
/// \throws Error limit_exceeded for more than `most_steps` steps of about ten nanoseconds, and 64 more for each face of
/// the view.
[[nodiscard]] std::vector<VisibleFace> find_faces(const Surfaces& surfaces, const View& view,
                                                  const std::vector<EdgeNeighbours>& sides, std::uint64_t most_steps,
                                                  const Execution& execution);

}  // namespace frontmost::faces_detail
