// SPDX-License-Identifier: Apache-2.0
// Functions that compute the colours of a batch, one for each Shading.
#pragma once

#include "frontmost/pictures.h"
#include "shade/light/lamps.h"
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
  const LightShadows& shadows;  ///< of these lights
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

struct Flat {
  const MaterialTable& materials;
  Isa isa;
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

struct Normals {
  const MaterialTable& materials;
  Isa isa;
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

/// World normals without mapping to colours, for normal_image.
struct RawNormals {
  const MaterialTable& materials;
  Isa isa;
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

struct Depths {
  glm::vec3 forward;
  float nearest, farthest;
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

/// Shows distances from the eye in place of depths.
struct Ranges {
  float nearest, farthest;
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

struct Ids {
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

struct Texcoords {
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

/// The linear value that is displayed as `value`, 0 to 1 in sRGB. The error is well below 1/1000 of a step of 8 bits.
[[nodiscard]] float linear_of_shown(float value);
[[nodiscard]] glm::vec3 linear_of_shown(const glm::vec3& value);
/// Bright for the nearest depth, dark for the farthest.
[[nodiscard]] glm::vec3 shown_depth(float depth, float nearest, float farthest);
/// A distinctive colour for an object; as displayed, 0 to 1.
[[nodiscard]] glm::vec3 color_of_object(std::uint32_t object);

}  // namespace frontmost::shading
