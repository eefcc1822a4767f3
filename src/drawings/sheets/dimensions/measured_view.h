// SPDX-License-Identifier: Apache-2.0
// The measurable features of a view: its extent along its axes, in units of the scene and on the page, and the circles
// that are seen along their axes.
#pragma once

#include "sheets/dimensions/dimensions.h"

namespace frontmost::detail {

/// A circle of the scene as it appears in a view.
struct SeenCircle {
  const Round* round;
  glm::dvec2 centre;  ///< on the page
  double radius;      ///< millimetres on the page
};

/// The extent of a view along one of its axes.
struct Extent {
  double low, high;                 ///< on the page
  double size;                      ///< in units of the scene
  const Round* diameter = nullptr;  ///< set if both ends belong to one cylinder
};

class MeasuredView {
 public:
  explicit MeasuredView(const DimensionedView& view);

  [[nodiscard]] const PageBox& box() const { return box_; }  ///< of all drawn lines
  [[nodiscard]] bool is_empty() const { return is_empty_; }
  /// The extent along axis 0 (to the right) or 1 (upwards). Rounds reach farther than the corners of their polygons.
  [[nodiscard]] Extent extent(int axis) const;
  /// The position, along the other axis, of the outermost point at one end of an axis: the lowest such point (y is
  /// down) for axis 0, the leftmost for axis 1.
  [[nodiscard]] double foot_of_end(int axis, double end) const;
  /// Circles that are seen along their axes and drawn to at least a fifth.
  [[nodiscard]] const std::vector<SeenCircle>& circles() const { return circles_; }
  /// Cylinders that are seen along their axes, but drawn less.
  [[nodiscard]] const std::vector<const Round*>& undrawn() const { return undrawn_; }
  /// The prisms of Rounds::prisms that are seen along their axes.
  [[nodiscard]] const std::vector<const Round*>& prisms() const { return prisms_; }
  [[nodiscard]] glm::dvec2 on_page(const glm::dvec3& point) const;

 private:
  void find_circles();
  [[nodiscard]] bool is_seen_along(const Round& round) const;

  const DimensionedView& view_;
  double millimetres_;  ///< millimetres of paper per unit of the scene
  bool is_empty_ = true;
  PageBox box_;
  std::vector<SeenCircle> circles_;
  std::vector<const Round*> undrawn_, prisms_;
};

}  // namespace frontmost::detail
