// SPDX-License-Identifier: Apache-2.0
// What pictures and figures ask of a scene and a view before they shade.
#pragma once

#include <limits>

#include "frontmost/pictures.h"

namespace frontmost::shading {

/// The depths between which a picture of depths goes from bright to dark.
struct DepthRange {
  float nearest = std::numeric_limits<float>::infinity(), farthest = -std::numeric_limits<float>::infinity();

  void include(const DepthRange& other) {
    nearest = std::min(nearest, other.nearest);
    farthest = std::max(farthest, other.farthest);
  }
};
/// Of what is visible; both 0 where nothing is. O(samples), in parallel.
[[nodiscard]] DepthRange depth_range(const Visible& visible, const Execution& execution);

/// Of any mesh.
[[nodiscard]] bool lacks_normals(const Scene& scene);
/// Colours come from materials.
[[nodiscard]] bool shows_materials(Shading shading);
/// \throws Error bad_argument unless one of both is given that can be visible.
void check_given(const ShadeInput& input, const char* who);
/// \throws Error bad_argument.
void check_opacity(const ShadeOptions& options);

}  // namespace frontmost::shading
