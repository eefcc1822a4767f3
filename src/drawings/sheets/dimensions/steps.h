// SPDX-License-Identifier: Apache-2.0
// Steps: plane faces that a view shows edge-on, as straight lines across a row of running dimensions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sheets/dimensions/dimensions.h"

namespace frontmost::detail {

/// A step along an axis of a view, in pixels.
struct PlaneStep {
  double at;      ///< along the axis
  double foot;    ///< along the other axis: the end of the step's lines that is nearest to the row of dimensions
  double length;  ///< of the visible lines together
  std::size_t plane = 0;  ///< number of the plane on the sheet
  bool is_spare = false;  ///< true: only for a plane that has no room in an earlier view
};

/// The steps along axis 0 (to the right) and 1 (upwards).
using ViewSteps = std::array<std::vector<PlaneStep>, 2>;

/// A view that may state steps.
struct SteppedView {
  const DimensionedView* view;
  glm::bvec2 has_datum;              ///< by axis: whether the view has a face from which steps can be measured
  std::vector<PrimitiveId> covered;  ///< ascending: triangles of faces that other dimensions define
};

/// The steps that each view states. A step is a plane face perpendicular to an axis of the view, of which the view
/// shows straight visible lines along the other axis, at least a fortieth of the view long in all. Faces at the ends of
/// the view are no steps. Each plane is a step of one view: the first one in which no line lies between the step and
/// the row of dimensions, or else the first one that shows it. In later views it is a spare step. At most 64 planes are
/// considered for each axis of a view, those of the longest lines. O(lines log lines).
[[nodiscard]] std::vector<ViewSteps> steps_of(std::span<const SteppedView> views);

}  // namespace frontmost::detail
