// SPDX-License-Identifier: Apache-2.0
// Adds the sheen of one light. The cloth below reflects light separately. Plain loops over lanes, like the other
// passes.

#include "shade/light/sheen.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/light/sheen_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
#include "shade/light/layers.h"
// After Highway: a block of its own.
#include "shade/light/fragment_terms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {

namespace {

/// `direction_at(i)` is the direction from fragment i to the light.
template <class DirectionAt>
void AddSheen(const glm::vec3& color, const DirectionAt& direction_at, FragmentBatch& batch) {
  LayerLanes& layers = batch.layers;
  const float red = color.x, green = color.y, blue = color.z;
  for (int i = 0; i < batch.coverage.count; ++i) {
    const Direction l = direction_at(i);
    const Direction n = direction_of(batch.geometry.normal, i), v = direction_of(batch.geometry.to_viewer, i);
    const Direction sum{v.x + l.x, v.y + l.y, v.z + l.z};
    const float scale = 1.0f / std::sqrt(at_least(dot(sum, sum), 1e-12f));
    const float n_h = clamp01((dot(n, v) + dot(n, l)) * scale), n_l = clamp01(dot(n, l));
    const float lobe = sheen_of({n_l, towards_viewer(n, v), n_h}, shown_sheen_roughness(layers.sheen_roughness[i]));
    const float arrives = n_l * batch.shadow[i] * lobe;
    layers.sheen_light.x[i] += red * arrives * layers.sheen.x[i];
    layers.sheen_light.y[i] += green * arrives * layers.sheen.y[i];
    layers.sheen_light.z[i] += blue * arrives * layers.sheen.z[i];
  }
}

}  // namespace

void AddDirectSheen(const DirectLight& light, FragmentBatch& batch) {
  const Direction to_light = direction_of(light.to_light);
  AddSheen(
      light.color, [&](int) { return to_light; }, batch);
}

void AddSheenFrom(const Lane3& to_light, const glm::vec3& color, FragmentBatch& batch) {
  AddSheen(
      color, [&](int i) { return direction_of(to_light, i); }, batch);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(AddDirectSheen);
FRONTMOST_KERNELS(AddSheenFrom);

void add_direct_sheen(const DirectLight& light, FragmentBatch& batch, Isa isa) {
  kernel_for(AddDirectSheenKernels, isa)(light, batch);
}

void add_sheen_from(const Lane3& to_light, const glm::vec3& color, FragmentBatch& batch, Isa isa) {
  kernel_for(AddSheenFromKernels, isa)(to_light, color, batch);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
