// SPDX-License-Identifier: Apache-2.0
// The fineness of curved primitives, and the triangles of a mesh of patches, without gaps between patches of different
// fineness.
//
//   a cell of a patch's grid beside a neighbour that is twice as fine: a fan about the cell's middle joins all points
//
//     +---------------+
//     | \           / |         Every edge has the points of its finest patch, at fractions of powers of two, so that
//     |   \       /   |         both sides compute the same points to the bit. Cells without finer neighbours are two
//     |     \   /     |         triangles.
//     |       +       |
//     |     / | \     |
//     |   /   |   \   |
//     | /     |     \ |
//     +-------+-------+  here the neighbour has one more point
#pragma once

#include <compare>
#include <span>
#include <tuple>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// A close upper bound of the number of triangles that tessellate() would make for the curved meshes, without making
/// any. The number may exceed the limit of tessellate(), and may be infinite. O(size of the scene). \throws Error as
/// tessellate() does, except for the limit.
[[nodiscard]] double tessellated_count(const Scene& scene, const View& view, double pixels);

/// Steps of a grid over a patch.
struct PatchLevel {
  int u = 1, v = 1;  ///< powers of two
  friend auto operator<=>(const PatchLevel&, const PatchLevel&) = default;
};

/// The fineness of one mesh at one place.
struct MeshLevel {
  std::vector<int> rings;  ///< by sphere, rings from pole to pole
  std::vector<PatchLevel> patches;

  friend bool operator<(const MeshLevel& a, const MeshLevel& b) {
    return std::tie(a.rings, a.patches) < std::tie(b.rings, b.patches);
  }
  /// An upper estimate, without the triangles that finer neighbours add.
  [[nodiscard]] double triangle_count() const;
};

/// The displacement of a point that a view tolerates, in world units. It depends on the point's distance along the
/// viewing axis.
class ScreenTolerance {
 public:
  /// Precondition: the view is valid, and pixels > 0.
  ScreenTolerance(const View& view, double pixels);

  /// The greatest displacement that moves no point of the hull of `points` (world space) farther on the screen than the
  /// tolerance. Infinity if all points lie before the near plane.
  [[nodiscard]] double of(std::span<const glm::dvec3> points) const;
  [[nodiscard]] double of_ball(const glm::dvec3& centre, double radius) const;

 private:
  [[nodiscard]] double at(double nearest, double farthest) const;
  [[nodiscard]] double distance(const glm::dvec3& p) const { return glm::dot(forward_, p - eye_); }

  glm::dvec3 eye_, forward_;
  double near_;
  double per_distance_ = 0, anywhere_ = 0;  ///< tolerance = anywhere + distance * per_distance
};

/// An upper bound of the distance between a patch and its grid of triangles: Muu / 8 u^2 + Muv / 4 uv + Mvv / 8 v^2
/// with the greatest second derivatives, for any triangles whose vertices lie on a cell of the grid.
class PatchBending {
 public:
  explicit PatchBending(std::span<const glm::dvec3, 16> points);
  [[nodiscard]] double error(const PatchLevel& level) const;
  [[nodiscard]] PatchLevel level_within(double tolerance) const;

 private:
  double uu_ = 0, uv_ = 0, vv_ = 0;
};

/// The greatest distance between the unit sphere and a globe of `rings` rings and twice as many columns.
[[nodiscard]] double globe_error(int rings);

/// The finest grids that are made. A primitive that would need a finer grid gets this one, which alone exceeds the
/// limit of triangles.
inline constexpr int finest_level = 1 << 13;

[[nodiscard]] MeshLevel level_of(const Mesh& mesh, const glm::dmat4& world_from_mesh, const ScreenTolerance& tolerance);

/// Numbers of steps along the four edges of a patch: along u = 0 and u = 1, where v grows, and along v = 0 and v = 1.
/// Each number is at least that of the patch's grid.
using EdgeLevels = std::array<int, 4>;

/// Edge levels such that each edge is as fine as its finest patch. Levels of patches that are not finite are arbitrary.
[[nodiscard]] std::vector<EdgeLevels> edge_levels(std::span<const BezierPatch> patches,
                                                  std::span<const PatchLevel> levels);

}  // namespace frontmost
