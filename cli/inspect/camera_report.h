// SPDX-License-Identifier: Apache-2.0
// One camera in every convention.
#pragma once

#include <frontmost/view.h>

#include <string>

#include "cli/json_numbers.h"

namespace frontmost::cli {

/// `target` is the focal point that the look-at form names.
[[nodiscard]] Json camera_json(const View& view, const glm::dvec3& target);
/// The options that make this view again.
[[nodiscard]] std::string camera_flags(const View& view, const glm::dvec3& target);
[[nodiscard]] std::string camera_text(const View& view, const glm::dvec3& target);

}  // namespace frontmost::cli
