// SPDX-License-Identifier: Apache-2.0
// Light on material layers. Varnish and fibres of cloth reflect light themselves and keep some of it from the surface
// below; glass transmits light. These functions are only for batches with such layers.
//
//   begin_layers      sets the layers' light to 0
//   add_...           adds to batch.coat->light and batch.layers.sheen_light, for every light, as for batch.light
//   lay_layers_over   combines all in batch.light
//   let_through       computes opacity, once light holds the final colour
#pragma once

#include "shade/light/lighting.h"

namespace frontmost::shading {

void begin_layers(FragmentBatch& batch);
/// Add the sheen for the light of add_direct_light() and add_light_from(). Precondition: layers.has_sheen.
void add_direct_sheen(const DirectLight& light, FragmentBatch& batch, Isa isa);
void add_sheen_from(const Lane3& to_light, const glm::vec3& color, FragmentBatch& batch, Isa isa);
/// Combines the layers. The light kept from below uses Fresnel terms of the view direction, for light from all
/// directions.
void lay_layers_over(FragmentBatch& batch);

/// Whether the light that glass mirrors is subtracted from the light that it transmits; by_view is for lit pictures.
enum class Mirroring : std::uint8_t { none, by_view };
/// Sets batch.alphas and the material's alpha of see-through fragments to their opacity, and divides their light by it.
/// So reflections on glass keep their brightness, however little the glass hides. Precondition:
/// layers.has_transmission.
void let_through(FragmentBatch& batch, Mirroring mirroring);
/// For blending that clips light at white: reflections brighter than that hide what is behind instead.
/// Precondition: let_through() was called.
void hide_by_highlights(FragmentBatch& batch);

}  // namespace frontmost::shading
