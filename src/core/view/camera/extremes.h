// SPDX-License-Identifier: Apache-2.0
// The few points of a model that decide how a view frames it.
//
// A side of the frustum touches a model at the point that reaches farthest in the direction in which the side moves.
// There are at most 132 such directions, so at most 132 points stand for a million: frame() finds the same view for
// them as for all points.
//
//         . * .
//      *  . . .  *       * kept: the farthest in some direction
//     . . . . . . .      . passed over
//       *  . . *
//           *
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/view.h"
#include "surfaces/cluster_set.h"

namespace frontmost {

/// The part of a frustum that a model is to fill, in axes in which opposite sides have opposite slopes. If the image
/// lies off the viewing axis, x and y are sheared along it, so that both are 0 in the middle of the image.
struct FilledFrustum {
  glm::dmat4 axes;            ///< right and up, sheared, and back
  glm::dvec2 middle, spread;  ///< slopes

  /// The sides of a perspective frustum, less `margin` of the picture on each.
  FilledFrustum(const glm::dmat4& world_from_eye, const Projection& sides, double margin);
};

/// Keeps, of any number of points, those that lie farthest in some fixed directions: exactly the directions in which
/// the sides of a frustum move, and 64 directions around each of the two planes in which two of the sides are lines.
/// The kept points depend on the set of points alone, not on their order. So a model in pieces is framed to the bit
/// like the whole model.
class Extremes {
 public:
  explicit Extremes(const FilledFrustum& frustum);

  /// Precondition: the point is finite.
  void include(const glm::vec3& point);
  /// Includes all vertices of finite triangles, except those of the objects `left_out`, whose numbers ascend. 1 to 3 ms
  /// for a million triangles. Boxes exclude most triangles; if boxes do not help, as in files whose order is random, a
  /// polygon does.
  void include(const PlacedScene& placed, std::span<const std::uint32_t> left_out = {});
  /// Includes all vertices of clusters. This is faster, because the triangles of a cluster are neighbours in space,
  /// whatever the order of the file.
  void include(const ClusterSet& set);
  /// False if no point within the box would be kept.
  [[nodiscard]] bool may_change_by(const Box& box) const;
  /// The kept points without repetition, in a fixed order.
  [[nodiscard]] std::vector<glm::vec3> points() const;

 private:
  static constexpr int around = 64;            ///< directions in each plane
  static constexpr int in_plane = around + 2;  ///< `around`, and the directions of the two sides
  static constexpr int direction_count = 2 * in_plane;
  struct Extent;
  struct Projected;
  class Core;
  template <class Parts>
  class Search;

  [[nodiscard]] Projected projected(const glm::dvec3& point) const;
  /// The reach of a point in a direction, with the one rounding that decides which point is kept.
  [[nodiscard]] double reach(int direction, const Projected& point) const;
  /// An upper bound of the reach of all points within a box.
  [[nodiscard]] double reach(int direction, const Extent& extent) const;
  void offer(int direction, double reach, const glm::vec3& point);
  /// False if the point would not be kept.
  [[nodiscard]] bool may_change_by(const Projected& point) const;

  struct Kept {
    glm::vec3 point{0};
    bool is_set = false;
  };

  glm::dvec3 across_[2], back_;
  glm::dvec2 spread_;
  double cosine_[around], sine_[around];
  double x_[direction_count], y_[direction_count], z_[direction_count];              ///< directions in world axes
  double abs_x_[direction_count], abs_y_[direction_count], abs_z_[direction_count];  ///< absolute values
  double reach_[direction_count];
  Kept kept_[direction_count];
};

}  // namespace frontmost
