// SPDX-License-Identifier: Apache-2.0
// A view with what can be measured in it: how far it reaches along its axes, in units of the scene and on the page, and
// which circles are seen along their axes.
#pragma once

#include "sheets/dimensions/dimensions.h"

namespace frontmost::detail {

/// A circle of the scene as one view shows it.
struct SeenCircle {
  const Round* round;
  glm::dvec2 centre;  ///< on the page
  double radius;      ///< likewise, millimetres
};

/// How far a view's scene reaches along one of its axes.
struct Extent {
  double low, high;                 ///< on the page
  double size;                      ///< in the scene's unit
  const Round* diameter = nullptr;  ///< where both ends are those of one cylinder
};

class MeasuredView {
 public:
  explicit MeasuredView(const DimensionedView& view);

  [[nodiscard]] const PageBox& box() const { return box_; }  ///< of all that is drawn
  [[nodiscard]] bool is_empty() const { return is_empty_; }
  /// 0: to the right, 1: upwards. What is round reaches farther than the corners of its polygons.
  [[nodiscard]] Extent extent(int axis) const;
  /// The place, along the other axis, of what is outermost at one end of an axis: the lowest such (y is down) for axis
  /// 0, the leftmost for axis 1.
  [[nodiscard]] double foot_of_end(int axis, double end) const;
  /// Those that are seen along their axes and are drawn, at least by a fifth.
  [[nodiscard]] const std::vector<SeenCircle>& circles() const { return circles_; }
  /// Cylinders that are seen along their axes, and of which less is drawn.
  [[nodiscard]] const std::vector<const Round*>& undrawn() const { return undrawn_; }
  /// Rounds::prisms that are seen along their axes.
  [[nodiscard]] const std::vector<const Round*>& prisms() const { return prisms_; }
  [[nodiscard]] glm::dvec2 on_page(const glm::dvec3& point) const;

 private:
  void find_circles();
  [[nodiscard]] bool is_seen_along(const Round& round) const;

  const DimensionedView& view_;
  double millimetres_;  ///< of paper to a unit of the scene
  bool is_empty_ = true;
  PageBox box_;
  std::vector<SeenCircle> circles_;
  std::vector<const Round*> undrawn_, prisms_;
};

}  // namespace frontmost::detail
