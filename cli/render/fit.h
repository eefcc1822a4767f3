// SPDX-License-Identifier: Apache-2.0
// How far away a camera must be to see a whole model.
#pragma once

#include <frontmost/surfaces.h>
#include <frontmost/view.h>

namespace frontmost::cli {

/// The box that views are fitted to: the model's, or a unit box for a model with no extent.
struct FitBounds {
  Box box;
  glm::dvec3 centre{0.0};
  double diagonal = 0;
};
[[nodiscard]] FitBounds visible_bounds(const Surfaces& surfaces);

/// Moves the eye back from `target` along its viewing direction, keeping its axes, until the whole box is in the
/// picture with a twentieth to spare on each side. In parallel projection the sides are widened instead.
void fit(View& view, const glm::dvec3& target, const FitBounds& bounds);

}  // namespace frontmost::cli
