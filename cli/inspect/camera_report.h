// SPDX-License-Identifier: Apache-2.0
// One camera in every convention.
#pragma once

#include <frontmost/view.h>

#include <string>

#include "cli/json.h"

namespace frontmost::cli {

/// `target` is the focal point that the look-at form names. The view and it are about the scene's `origin`; what is
/// reported is in the coordinates of the model's file.
[[nodiscard]] Json camera_json(const View& view, const glm::dvec3& target, const glm::dvec3& origin);
/// The options that make this view again.
[[nodiscard]] std::string camera_flags(const View& view, const glm::dvec3& target, const glm::dvec3& origin);
[[nodiscard]] std::string camera_text(const View& view, const glm::dvec3& target, const glm::dvec3& origin);

}  // namespace frontmost::cli
