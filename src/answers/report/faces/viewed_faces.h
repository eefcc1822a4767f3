// SPDX-License-Identifier: Apache-2.0
// The triangles that a view may show, on its screen, and at which of their sides a surface ends.
//
//       .-----.-----.         A side is plain where exactly one other triangle lies beyond it, on its other side as it
//       is
//      / \ p / \   / \        seen: there the number of surfaces over a place does not change. It changes at the
//      others:
//     /   \ /   \ /   \       where a surface folds back (its contour), where it has a rim, and where it was cut by the
//    '-----'-----'-----'      near plane.
//      c     c     c
#pragma once

#include <vector>

#include "frontmost/view.h"
#include "report/faces/measures.h"
#include "report/faces/mesh_sides.h"

namespace frontmost::faces_detail {

/// What is narrower than this, in pixels, is not told apart from what lies beside it: 2^-30. Doubles put a place to
/// some 2^-38 pixel.
inline constexpr double kNarrow = 1.0 / (1 << 30);

/// A rectangle of the picture, in pixels.
struct CellBox {
  double left, top, right, bottom;
};

/// A triangle, or a part of one that was clipped.
struct ViewedFace {
  std::uint32_t corners[3];  ///< numbers of points
  PrimitiveId id;
};

struct ViewedFaces {
  Buffer<ScreenPoint> points;   ///< of vertices by instance and number, and those of what was clipped
  Buffer<ViewedFace> faces;     ///< by id, ascending; parts of one triangle follow each other
  Buffer<std::uint8_t> ending;  ///< by face, bit k: a surface ends at side k, from corner k to the next
};

/// Twice the area, positive where the corners turn to the right as they are seen (y points down).
[[nodiscard]] inline double turn_of(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// What is within the picture, at least in part, between near and far, is wider than kNarrow, and is not left out by
/// View::culling. `sides`: by mesh.
[[nodiscard]] ViewedFaces viewed_faces(const Surfaces& surfaces, const View& view,
                                       const std::vector<EdgeNeighbours>& sides, const Execution& execution);

}  // namespace frontmost::faces_detail
