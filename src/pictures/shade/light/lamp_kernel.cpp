// SPDX-License-Identifier: Apache-2.0
// The light of a lamp at each fragment, by its distance, range window and cone.

#include "shade/light/lamps.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/light/lamp_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// After Highway: a block of its own.
#include "shade/light/fragment_terms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {

void FindLampLight(const Lamp& lamp, const FragmentBatch& batch, LampLight& out) {
  const Lane3& position = batch.geometry.position;
  const Direction at = direction_of(lamp.position), axis = direction_of(lamp.axis);
  const float per_range2 = lamp.range > 0 ? 1.0f / (lamp.range * lamp.range) : 0.0f;
  const float scale = lamp.cone_scale, offset = lamp.cone_scale > 0 ? -lamp.cosine_outer * scale : 1.0f;
  for (int i = 0; i < batch.coverage.count; ++i) {
    const Direction to{at.x - position.x[i], at.y - position.y[i], at.z - position.z[i]};
    // A point at the lamp would get infinite light from no direction, so the least distance is 1e-4 units.
    const float distance2 = at_least(dot(to, to), 1e-8f), per_distance = 1.0f / std::sqrt(distance2);
    const Direction l{to.x * per_distance, to.y * per_distance, to.z * per_distance};
    const float in_range = distance2 * per_range2;
    const float window = at_least(1.0f - in_range * in_range, 0.0f);
    const float cone = clamp01(offset - dot(l, axis) * scale);
    out.to_lamp.x[i] = l.x;
    out.to_lamp.y[i] = l.y;
    out.to_lamp.z[i] = l.z;
    out.part[i] = window * (cone * cone) / distance2;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(FindLampLight);

void find_lamp_light(const Lamp& lamp, const FragmentBatch& batch, LampLight& light, Isa isa) {
  kernel_for(FindLampLightKernels, isa)(lamp, batch, light);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
