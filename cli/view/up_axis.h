// SPDX-License-Identifier: Apache-2.0
// Whether a model looks as if another axis than the scene's were up.
#pragma once

#include <frontmost/scene.h>

#include <optional>
#include <string>

#include "cli/settings.h"

namespace frontmost::cli {

/// Whether the camera is aimed by what is up.
[[nodiscard]] bool depends_on_up(const ViewSettings& view);

/// A warning that names --up, where the view depends on it, nobody has told it, the format leaves it open, and the
/// model lies for all that its triangles tell: a flat base at the low side of the other axis that files are made with,
/// y or z, and no other flat side. None otherwise. O(triangles), of a million at most.
[[nodiscard]] std::optional<std::string> up_warning(const ViewSettings& view, const LoadOptions& load,
                                                    const Surfaces& surfaces);

}  // namespace frontmost::cli
