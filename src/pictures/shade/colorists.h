// SPDX-License-Identifier: Apache-2.0
// What a picture shows of a batch, one for each Shading.
#pragma once

#include "frontmost/pictures.h"
#include "shade/light/lamps.h"
#include "shade/material/materials.h"
#include "shade/occlusion/depth_occlusion.h"
#include "shade/shadow/light_shadows.h"
#include "shade/tile.h"

namespace frontmost::shading {

/// Base colour, metallic-roughness and light.
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
/// The light of a picture, which is borrowed, and its shadows. What is found stays in the scene.
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

/// World normals as they are, for normal_image.
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

/// Distances from the eye in place of depths.
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

/// The linear value that is shown as `value` of 0 to 1 in sRGB, to well within 1/1000 of a step of 8 bits.
[[nodiscard]] float linear_of_shown(float value);
[[nodiscard]] glm::vec3 linear_of_shown(const glm::vec3& value);
/// Bright where a depth is the nearest, dark where it is the farthest.
[[nodiscard]] glm::vec3 shown_depth(float depth, float nearest, float farthest);
/// As shown on a screen, 0 to 1.
[[nodiscard]] glm::vec3 color_of_object(std::uint32_t object);

}  // namespace frontmost::shading
