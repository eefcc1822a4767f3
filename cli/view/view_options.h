// SPDX-License-Identifier: Apache-2.0
// From what was said about the camera to a View.
#pragma once

#include <frontmost/scene.h>
#include <frontmost/view.h>

#include <optional>
#include <string>

#include "cli/settings.h"

namespace frontmost::cli {

/// Reads the file that the pose lies in, where it does and was not read yet.
/// \throws UsageError where there is no such file; Error naming file and line for one that holds no pose.
void read_pose_file(ViewSettings& settings);

/// Finds options that exclude or need one another, before any model is read.
/// \throws UsageError naming them
void check_view_settings(const ViewSettings& settings);

/// The view for these surfaces; `samples` is left at 1. Where no position is given the model is fitted into the
/// picture. What the settings say is in the coordinates of the model's file; a view is about the scene's origin.
/// \throws UsageError for a camera number that the model has not; Error from the library's own checks.
[[nodiscard]] View resolve_view(const ViewSettings& settings, const Surfaces& surfaces);

/// Whether the picture is fitted to find_subject(), so that other objects may reach out of it.
[[nodiscard]] bool is_fitted_to_subject(const ViewSettings& settings);

/// What there is to say where it is, and there are such objects. O(objects).
[[nodiscard]] std::optional<std::string> framing_warning(const ViewSettings& settings, const Surfaces& surfaces);

/// The bounds that planes are fitted to: the model's, or those of a unit box about the origin for a model without any.
[[nodiscard]] Box framed_box(const Surfaces& surfaces);

/// False when resolve_view() gives the same for all surfaces: the camera is placed, and both planes are told.
[[nodiscard]] bool depends_on_model(const ViewSettings& settings);

/// What {view} stands for: the given name, the named direction, or how the camera was told.
[[nodiscard]] std::string view_name(const ViewSettings& settings);

/// What the camera turns about, in world space: the focal point that was given, or else the middle of what is framed,
/// brought onto the viewing axis.
[[nodiscard]] glm::dvec3 focal_point_of(const ViewSettings& settings, const View& view, const Surfaces& surfaces);

}  // namespace frontmost::cli
