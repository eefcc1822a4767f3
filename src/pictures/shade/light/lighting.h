// SPDX-License-Identifier: Apache-2.0
// The light of a lit picture, and what surfaces make of it: passes over a batch, each of which adds to batch.light.
//
//   begin_light        what the surface sends out by itself
//   add_direct_light   one light from one direction, weakened by batch.shadow; once for every light
//   add_surroundings   what comes from all around, weakened by the material's occlusion
//   finish_light       what a picture can hold: exposure, then tone mapping
//
// One key light that moves with the camera, from the upper left and before the model, so that whatever is looked at is
// lit and throws its shadow to the lower right; and a studio around it that turns with the camera. Intensities are
// given as what a white matt surface sends back: facing the key light it comes to just below 1, so that a texture's
// colours survive and nothing has to be mapped down afterwards.
#pragma once

#include "frontmost/pictures.h"
#include "shade/batch.h"
#include "shade/environment/prefiltered.h"

namespace frontmost::shading {

/// A light so far away that all of it comes from one direction.
struct DirectLight {
  glm::vec3 to_light{0, 0, 1};            ///< unit
  glm::vec3 color{0.64f, 0.63f, 0.615f};  ///< what a white matt surface that faces it sends back

  [[nodiscard]] bool is_on() const { return color != glm::vec3(0); }
};

/// What a white matt surface sends back of an environment, by its unit normal in the world: factors of its coordinates
/// and of their products, by colour channel.
struct IrradiancePolynomial {
  glm::vec3 constant{0}, x{0}, y{0}, z{0}, xx{0}, yy{0}, zz{0}, xy{0}, yz{0}, zx{0};
};

struct Surroundings {
  const PrefilteredEnvironment* environment = nullptr;  ///< null: no light
  glm::mat3 world_from_environment{1};                  ///< a turn
  IrradiancePolynomial irradiance;
};

struct Lighting {
  DirectLight key;
  Surroundings around;
  float exposure = 1;  ///< light is multiplied by this
  ToneMapping tone_mapping = ToneMapping::none;
};

[[nodiscard]] inline bool counts_key(Lights lights) { return lights == Lights::key || lights == Lights::both; }

/// \throws Error bad_argument as LightOptions says.
void check_light(const LightOptions& options);
/// The direction of the key light, of unit length. Precondition: check_light().
[[nodiscard]] glm::vec3 direction_to_key(const View& view, const LightOptions& options);
/// How much of the key light there is. Precondition: check_light().
[[nodiscard]] double key_intensity(const LightOptions& options);
/// The light of a picture of a scene with this up. Borrows the environment, which the options name or leave open.
/// Precondition: check_light().
[[nodiscard]] Lighting lighting_for(const View& view, Axis up, const LightOptions& options,
                                    const Environment& environment);

void begin_light(FragmentBatch& batch);
/// Metallic-roughness with GGX highlights (Schlick's Fresnel, Smith's correlated masking).
void add_direct_light(const DirectLight& light, FragmentBatch& batch, Isa isa);
/// The same of a light that lies another way from every fragment.
void add_light_from(const Lane3& to_light, const glm::vec3& color, FragmentBatch& batch, Isa isa);
/// The same surface in the environment's light, by the split sum and with what is mirrored more than once.
void add_surroundings(const Surroundings& around, FragmentBatch& batch, Isa isa);
/// Lays the layers of materials over the rest, and brings the light to 0 to 1. Unlit materials give their base colour.
void finish_light(const Lighting& lighting, FragmentBatch& batch, Isa isa);

}  // namespace frontmost::shading
