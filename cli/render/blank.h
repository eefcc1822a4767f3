// SPDX-License-Identifier: Apache-2.0
// Why a picture is blank.
#pragma once

#include <frontmost/surfaces.h>
#include <frontmost/visible.h>

#include <string>

namespace frontmost::cli {

/// True when no sample sees anything.
[[nodiscard]] bool is_blank(const Visible& visible);

/// What keeps all triangles of a blank picture out of it, in a clause: "all of the model is behind the camera".
/// O(triangles).
[[nodiscard]] std::string blank_reason(const Surfaces& surfaces, const View& view);

}  // namespace frontmost::cli
