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
  const DepthOcclusion* occlusion = nullptr;  ///< null: none
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;

 private:
  void add_far(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
  void add_near(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

struct PreparedScene;
/// The colorist for the light of a picture and its shadows; borrows the light. Prepared data stays in `scene`.
[[nodiscard]] Lit lit_by(const Lighting& lighting, const ShadedPicture& picture, PreparedScene& scene,
                         const Execution& execution);

/// The colorist of a picture that is flat, of normals, ids or texture coordinates. Borrows the materials.
[[nodiscard]] FragmentShader::Colorist unlit_colorist(Shading shading, const MaterialTable& materials, Isa isa);
/// World normals without mapping to colours, for normal_image(). Borrows the materials.
[[nodiscard]] FragmentShader::Colorist normal_colorist(const MaterialTable& materials, Isa isa);

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
/// The colorists of pictures of depths, and of distances from the eye.
[[nodiscard]] FragmentShader::Colorist depth_colorist(const DepthRange& range, const glm::vec3& forward);
[[nodiscard]] FragmentShader::Colorist distance_colorist(const DepthRange& range);

/// The linear value that is displayed as `value`, 0 to 1 in sRGB. The error is well below 1/1000 of a step of 8 bits.
[[nodiscard]] glm::vec3 linear_of_shown(const glm::vec3& value);

}  // namespace frontmost::shading
