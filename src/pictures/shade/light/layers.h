// SPDX-License-Identifier: Apache-2.0
// Light on the layers of materials: a varnish and the fibres of a cloth send back light by themselves, and keep some
// from what lies below; glass lets it through. Only for batches that have such layers.
//
//   begin_layers      nothing yet
//   add_...           to batch.coat->light and batch.layers.sheen_light, as to batch.light, once for every light
//   lay_layers_over   all of it together in batch.light
//   let_through       how much of what is behind shows through, when light is what the picture holds
#pragma once

#include "shade/light/lighting.h"

namespace frontmost::shading {

void begin_layers(FragmentBatch& batch);
/// The sheen of what add_direct_light() and add_light_from() add. Precondition: layers.has_sheen.
void add_direct_sheen(const DirectLight& light, FragmentBatch& batch, Isa isa);
void add_sheen_from(const Lane3& to_light, const glm::vec3& color, FragmentBatch& batch, Isa isa);
/// Fresnel's terms for what is kept from below are those of the view: the same for light from all directions.
void lay_layers_over(FragmentBatch& batch);

/// Whether what glass mirrors is taken off what it lets through: in lit pictures.
enum class Mirroring : std::uint8_t { none, by_view };
/// Where light passes, sets batch.alphas and the material's alpha to how much is hidden, and makes the light straight
/// by that: what glass mirrors is as bright as it is, however little the glass hides. Precondition:
/// layers.has_transmission.
void let_through(FragmentBatch& batch, Mirroring mirroring);
/// For blends that know no light above white: what glass mirrors beyond it hides what is behind instead.
/// Precondition: let_through() was called.
void hide_by_highlights(FragmentBatch& batch);

}  // namespace frontmost::shading
