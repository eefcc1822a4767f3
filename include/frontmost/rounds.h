// SPDX-License-Identifier: Apache-2.0
// Rounds: the circles, cylinders and surfaces of revolution that a scene's triangles stand for, and their centre lines
// in a drawing.
//
//            |
//         .-~|~-.         +-----------------+
//   - - /- - + - -\ - -   |- - - - - - - - -|- -
//       \    |    /       +-----------------+
//         `-~|~-'
//            |
//
// A file of triangles has a polygon where its maker had a circle. Drawings need the circle: a cross over it when it is
// seen along its axis, an axis when it is seen from the side, and a diameter among the dimensions.
#pragma once

#include <vector>

#include "frontmost/strokes.h"

namespace frontmost {

enum class RoundKind : std::uint8_t { circle, cylinder, revolved };

/// A circle of sharp edges, a cylinder of smooth triangles, or all of a smooth surface that is round about an axis.
struct Round {
  RoundKind kind = RoundKind::circle;
  glm::dvec3 from{0}, to{0};           ///< ends of the axis, in world space; of a circle both its centre
  glm::dvec3 axis{0, 0, 1};            ///< of unit length
  double radius = 0;                   ///< of the circle on which the vertices lie; revolved: of the largest
  double turn = 0;                     ///< radians, at most 2 pi: how much of it there is
  bool is_hollow = false;              ///< a cylinder: what it bounds lies outside of it, as of a bore
  std::uint32_t first = 0, count = 0;  ///< in Rounds::triangles
};

struct Rounds {
  std::vector<Round> rounds;
  /// Those with a side on the circle, or of the surface. In the order of the rounds, each's ascending.
  std::vector<PrimitiveId> triangles;
  /// Cylinders of 7 to 17 sides with a sharp rim at either end. They count as polygons: nothing is drawn for them.
  std::vector<Round> prisms;
};

/// The circles and cylinders of a scene of which at least 160 degrees are there, and what else is round about an axis.
///
/// Surfaces are smooth where triangles meet at 20 degrees or less, so that a polygon of 18 sides and more is round, as
/// it is to chain_strokes(). Edges that are not smooth are followed from one to the next; where their corners lie on a
/// circle they are one. A cylinder is grown from two neighbours over all that lie smoothly about the same axis, at the
/// same distance. Corners may be off by a quarter of how far the middle of a side is, or by what six digits leave open
/// where that is more; so nothing is asked of what is not tessellated from something round. From a circle's edge a
/// cylinder may have corners within its sides as well, where something else cuts it. Surfaces of revolution are what is
/// smooth from one triangle to the next, goes all the way round and has its corners in rings of 18 and more: tori,
/// domes, cones; but not cylinders, nor whole spheres, which have no axis of their own. Near-linear. \throws Error
/// limit_exceeded for more than 2^30 triangles.
[[nodiscard]] Rounds find_rounds(const Surfaces& surfaces, const Execution& execution = {});

/// How much of each round a drawing shows, in pixels: of what is seen, and with `with_hidden` of what is not.
[[nodiscard]] std::vector<double> drawn_lengths(const Rounds& rounds, const Drawing& drawing, bool with_hidden);

/// Where a point of world space is in a parallel view, in pixels.
[[nodiscard]] glm::dvec2 on_screen(const View& view, const glm::dvec3& point);

struct CentreLineOptions {
  bool with_hidden = true;  ///< false: what shows no line that is seen has none
  double overshoot = 30;    ///< pixels, above 0: how far they reach beyond what they are drawn for
};

/// In pixels of the view, as DrawnPart's.
struct CentreLine {
  glm::dvec2 from{0}, to{0};
  friend bool operator==(const CentreLine&, const CentreLine&) = default;
};

/// Centre lines as ISO 128 has them: crosses over circles and cylinders that are seen along their axes, and over what
/// is a circle in `strokes`, one at each place; axes of what is seen from the side, one along each line. None for what
/// is seen at an angle, is smaller than a third of the overshoot, or of which less than a fifth is drawn; nor in
/// perspective. `rounds` are those of the surfaces of the drawing. Small circles have crosses that reach beyond them by
/// their radius alone, but by a third of the overshoot at least. In the order of their directions and places.
/// \throws Error bad_argument for an overshoot out of range.
[[nodiscard]] std::vector<CentreLine> centre_lines_of(const Rounds& rounds, const Drawing& drawing,
                                                      const Strokes& strokes, const CentreLineOptions& options = {});

}  // namespace frontmost
