// SPDX-License-Identifier: Apache-2.0
// What a picture shows of a batch, one for each Shading.
#pragma once

#include "frontmost/shade.h"
#include "shade/lighting.h"
#include "shade/materials.h"
#include "shade/shadow/ray_shadows.h"
#include "shade/shadow/shadow_map.h"
#include "shade/tile.h"

namespace frontmost::shading {

/// Base colour, metallic-roughness and light. One of `map` and `rays` at most is not null.
struct Lit {
  const MaterialTable& materials;
  const Lighting& lighting;
  const ShadowMap* map;
  const RayShadows* rays;
  Isa isa;
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

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

struct Ids {
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

struct Texcoords {
  void operator()(const std::vector<TriangleSetup>& setups, FragmentBatch& batch) const;
};

/// The linear value that is shown as `value` of 0 to 1 in sRGB, to well within 1/1000 of a step of 8 bits.
[[nodiscard]] float linear_of_shown(float value);
[[nodiscard]] glm::vec3 linear_of_shown(const glm::vec3& value);
/// As shown on a screen, 0 to 1.
[[nodiscard]] glm::vec3 color_of_object(std::uint32_t object);

}  // namespace frontmost::shading
