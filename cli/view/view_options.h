// SPDX-License-Identifier: Apache-2.0
// Makes a View of the camera settings.
#pragma once

#include <frontmost/scene.h>
#include <frontmost/view.h>

#include <optional>
#include <string>

#include "cli/settings.h"

namespace frontmost::cli {

/// Reads the pose's file, if there is one that has not been read yet.
/// \throws UsageError if the file is missing; Error naming file and line if it holds no pose.
void read_pose_file(ViewSettings& settings);

/// Finds options that exclude or need one another, before a model is read.
/// \throws UsageError naming them
void check_view_settings(const ViewSettings& settings);

/// Returns the view of these surfaces, of which `samples` is left at 1. Without a position, the model is fitted into
/// the picture. Settings are in the coordinates of the model's file, and the view is relative to the scene's origin.
/// \throws UsageError for a camera number that the model lacks; Error from the library's own checks.
[[nodiscard]] View resolve_view(const ViewSettings& settings, const Surfaces& surfaces);

/// Whether the picture is fitted to find_subject(), so that other objects may reach out of it.
[[nodiscard]] bool is_fitted_to_subject(const ViewSettings& settings);

/// Returns a warning if is_fitted_to_subject() and objects reach out of the picture. O(objects).
[[nodiscard]] std::optional<std::string> framing_warning(const ViewSettings& settings, const Surfaces& surfaces);

/// Returns bounds for fitting clip planes: the model's, or a unit box about the origin if the model has none.
[[nodiscard]] Box framed_box(const Surfaces& surfaces);

/// Whether the view depends on the surfaces. It does not if the camera and both planes are given.
[[nodiscard]] bool depends_on_model(const ViewSettings& settings);

/// Returns the text for {view}: the given name, the named direction, or the way in which the camera was given.
[[nodiscard]] std::string view_name(const ViewSettings& settings);

/// Returns the centre of rotation of the camera, in world space: the given focal point, or else the centre of the
/// framed objects, projected onto the viewing axis.
[[nodiscard]] glm::dvec3 focal_point_of(const ViewSettings& settings, const View& view, const Surfaces& surfaces);

}  // namespace frontmost::cli
