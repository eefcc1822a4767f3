// SPDX-License-Identifier: Apache-2.0
// The few points of a model that decide how a view frames it.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "frontmost/base.h"

namespace frontmost {

/// Keeps, of any number of points, those that lie farthest in some fixed directions: those in which the sides of a
/// frustum move, exactly, and 64 around each of the two planes in which its sides can be drawn. The points kept depend
/// on the set of points alone, not on their order, so a model seen in pieces is framed to the bit as one seen whole.
class Extremes {
 public:
  /// For a frustum that looks along -z of `axes`, with sides at slopes of `spread` in x and y.
  Extremes(const glm::dmat4& axes, const glm::dvec2& spread);

  /// Precondition: finite.
  void include(const glm::vec3& point);
  /// False when no point within the box would be kept.
  [[nodiscard]] bool may_change_by(const Box& box) const;
  /// Without repetition, in an order of their own.
  [[nodiscard]] std::vector<glm::vec3> points() const;

 private:
  static constexpr int around = 64;            ///< directions in each plane
  static constexpr int in_plane = around + 2;  ///< and those of the two sides
  static constexpr int direction_count = 2 * in_plane;

  struct Kept {
    glm::vec3 point{0};
    bool is_set = false;
  };
  void offer(int direction, double reach, const glm::vec3& point);

  glm::dvec3 right_, up_, back_;
  glm::dvec2 spread_;
  double cosine_[around], sine_[around];
  double x_[direction_count], y_[direction_count], z_[direction_count];  ///< the directions in world axes
  double reach_[direction_count];
  Kept kept_[direction_count];
};

}  // namespace frontmost
