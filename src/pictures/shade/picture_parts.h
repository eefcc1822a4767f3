// SPDX-License-Identifier: Apache-2.0
// Facts about a scene and a view that pictures and figures need before shading.
#pragma once

#include <limits>

#include "frontmost/pictures.h"

namespace frontmost::shading {

/// The range of depths that a picture of depths maps from bright to dark.
struct DepthRange {
  float nearest = std::numeric_limits<float>::infinity(), farthest = -std::numeric_limits<float>::infinity();

  void include(const DepthRange& other) {
    nearest = std::min(nearest, other.nearest);
    farthest = std::max(farthest, other.farthest);
  }
};
/// The range of all visible depths; both 0 where nothing is visible. O(samples), in parallel.
[[nodiscard]] DepthRange depth_range(const Visible& visible, const Execution& execution);

/// Whether any mesh of the scene lacks normals.
[[nodiscard]] bool lacks_normals(const Scene& scene);
/// Whether colours come from materials.
[[nodiscard]] bool shows_materials(Shading shading);
/// \throws Error bad_argument unless exactly one of both inputs is given and it is valid.
void check_given(const ShadeInput& input, const char* who);
/// \throws Error bad_argument.
void check_opacity(const ShadeOptions& options);

}  // namespace frontmost::shading
