// SPDX-License-Identifier: Apache-2.0
// The light of a lit picture, and what surfaces make of it.
//
// One key light that moves with the camera, from the upper left and before the model, so that whatever is looked at is
// lit and throws its shadow to the lower right; and a surrounding that is bright above and darker below, by the
// scene's own up. Intensities are given as what a white matt surface sends back: facing the key light under open sky
// it comes to just below 1, so that a texture's colours survive and nothing has to be mapped down afterwards.
#pragma once

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "shade/batch.h"

namespace frontmost::shading {

struct Lighting {
  glm::vec3 to_key{0, 0, 1};  ///< unit
  glm::vec3 up{0, 1, 0};      ///< the scene's
  glm::vec3 key{0.64f, 0.63f, 0.615f};
  glm::vec3 sky{0.33f, 0.335f, 0.345f};
  glm::vec3 ground{0.17f, 0.165f, 0.16f};
  /// What smooth surfaces mirror of the box that the key light shines from, as a multiple of the key.
  float box = 1.4f;
};

[[nodiscard]] Lighting lighting_for(const View& view, Axis up);

/// Fills batch.light: metallic-roughness with GGX highlights (Schlick's Fresnel, Smith's correlated masking), the key
/// light weakened by batch.shadow, and the surrounding by its occlusion. Unlit materials give their base colour.
/// Values are cut off at 1.
void light_batch(const Lighting& lighting, FragmentBatch& batch, Isa isa = Isa::best);

}  // namespace frontmost::shading
