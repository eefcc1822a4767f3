// SPDX-License-Identifier: Apache-2.0
// Checks whether a model looks as if another axis than the scene's were up.
#pragma once

#include <frontmost/scene.h>

#include <optional>
#include <string>

#include "cli/settings.h"

namespace frontmost::cli {

/// Whether the camera's direction depends on the up axis.
[[nodiscard]] bool depends_on_up(const ViewSettings& view);

/// Returns a warning that names --up if the model seems to lie: it has a flat base at the low side of the other usual
/// up axis, y or z, and no other flat side. Returns nothing unless the view depends on the up axis, nobody stated it,
/// and the format leaves it open. O(triangles), of a million at most.
[[nodiscard]] std::optional<std::string> up_warning(const ViewSettings& view, const LoadOptions& load,
                                                    const Surfaces& surfaces);

}  // namespace frontmost::cli
