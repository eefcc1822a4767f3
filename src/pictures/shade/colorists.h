// SPDX-License-Identifier: Apache-2.0
// Functions that compute the colours of a batch, one for each Shading.
#pragma once

#include <algorithm>
#include <limits>

#include "frontmost/pictures.h"
#include "shade/light/lighting.h"
#include "shade/material/materials.h"
#include "shade/occlusion/depth_occlusion.h"
#include "shade/shadow/light_shadows.h"
#include "shade/tile.h"

namespace frontmost::shading {

/// Shades with base colour, metallic-roughness and light.
struct Lit {
  const MaterialTable& materials;
  const Lighting& lighting;
  const PictureLights& lights;
  const LightShadows& shadows;  ///< shadows of these lights
  Isa isa;
  const DepthOcclusion* occlusion = nullptr;  ///< null if no ambient occlusion is wanted
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;

 private:
  void add_far(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
  void add_near(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

struct PreparedScene;
/// Returns the colorist for the lights of a picture and their shadows. Borrows `lighting`; the scene keeps what is
/// prepared.
[[nodiscard]] Lit lit_by(const Lighting& lighting, const ShadedPicture& picture, PreparedScene& scene,
                         const Execution& execution);

/// Returns the colorist for Shading flat, normals, ids or uv. Borrows the materials.
[[nodiscard]] FragmentShader::Colorist unlit_colorist(Shading shading, const MaterialTable& materials, Isa isa);
/// Returns the colorist of normal_image(), whose values are world normals and not colours. Borrows the materials.
[[nodiscard]] FragmentShader::Colorist normal_colorist(const MaterialTable& materials, Isa isa);

/// A range of depths. Pictures of depths map it to brightness, the nearest to bright.
struct DepthRange {
  float nearest = std::numeric_limits<float>::infinity(), farthest = -std::numeric_limits<float>::infinity();

  void include(const DepthRange& other) {
    nearest = std::min(nearest, other.nearest);
    farthest = std::max(farthest, other.farthest);
  }
};
/// Returns the range of all visible depths, or 0 and 0 if nothing is visible. O(samples), in parallel.
[[nodiscard]] DepthRange depth_range(const Visible& visible, const Execution& execution);
/// Returns the colorist of pictures of planar depths. The next function returns that of distances from the eye.
[[nodiscard]] FragmentShader::Colorist depth_colorist(const DepthRange& range, const glm::vec3& forward);
[[nodiscard]] FragmentShader::Colorist distance_colorist(const DepthRange& range);

/// Returns the linear value that is displayed as `value`, which is sRGB, 0 to 1. The error is well below 1/1000 of an
/// 8-bit step.
[[nodiscard]] glm::vec3 linear_of_shown(const glm::vec3& value);

}  // namespace frontmost::shading
