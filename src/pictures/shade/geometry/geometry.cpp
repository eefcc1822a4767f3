// SPDX-License-Identifier: Apache-2.0
#include "shade/geometry/geometry.h"

#include <algorithm>

#include "base/parallel.h"

namespace frontmost::shading {
namespace {

/// Has no branches, so that the compiler can vectorize it.
bool all_equal(const PrimitiveId* ids, std::size_t count, PrimitiveId id) {
  PrimitiveId different = 0;
  for (std::size_t i = 0; i < count; ++i) different |= ids[i] ^ id;
  return different == 0;
}

}  // namespace

BitSet seen_primitives(const Surfaces& surfaces, const Visible& visible, const Execution& execution, BitSet memory) {
  const std::span<const PrimitiveId> ids(visible.primitives.data(), visible.primitives.size());
  return seen_primitives(surfaces.primitive_count(), ids, execution, std::move(memory));
}

BitSet seen_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids, const Execution& execution,
                       BitSet memory) {
  BitSet seen = std::move(memory);
  seen.clear(primitive_count);
  constexpr std::size_t samples_at_once = 1u << 16, run = 64;
  parallel_for(execution, ids.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    PrimitiveId last = no_primitive;
    for (std::size_t first = begin; first < end; first += run) {
      const std::size_t count = std::min(run, end - first);
      if (all_equal(ids.data() + first, count, last)) continue;
      for (std::size_t i = first; i < first + count; ++i) {
        const PrimitiveId id = ids[i];
        if (id == last) continue;
        last = id;
        if (id != no_primitive) seen.add(id);
      }
    }
  });
  return seen;
}

BitSet large_primitives(std::size_t primitive_count, const Visible& visible, const Execution& execution,
                        BitSet memory) {
  const std::span<const PrimitiveId> first(visible.primitives.data(), visible.view.pixel_count());
  return large_primitives(primitive_count, first, visible.view.width, execution, std::move(memory));
}

BitSet large_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids, int width,
                        const Execution& execution, BitSet memory) {
  BitSet large = std::move(memory);
  large.clear(primitive_count);
  parallel_for(execution, ids.size() / std::size_t(width), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const PrimitiveId* row = ids.data() + y * std::size_t(width);
      const auto is_at = [&](PrimitiveId id, int x, int up) {
        return x >= 0 && std::size_t(up) <= y && row[x - up * width] == id;
      };
      PrimitiveId last = no_primitive;
      for (int x = 0; x < width; ++x) {
        const PrimitiveId id = row[x];
        if (id == no_primitive || id == last) continue;
        const bool left = is_at(id, x - 1, 0), above = is_at(id, x, 1);
        if ((left && (above || is_at(id, x - 2, 0))) || (above && is_at(id, x, 2))) {
          large.add(id);
          last = id;
        }
      }
    }
  });
  return large;
}

std::vector<bool> seen_materials(const Surfaces& surfaces, const BitSet& seen, const BitSet& known) {
  const Scene& scene = surfaces.scene();
  std::vector<bool> result(scene.materials.size());
  std::uint32_t instance = 0;
  seen.visit_new(known, [&](std::size_t id) {
    const auto triangle_count = [&] { return scene.meshes[scene.instances[instance].mesh].triangles.size(); };
    while (id >= surfaces.first_primitive(instance) + triangle_count()) ++instance;
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const std::uint32_t material = mesh.material_of(std::uint32_t(id - surfaces.first_primitive(instance)));
    if (material < result.size()) result[material] = true;
  });
  return result;
}

}  // namespace frontmost::shading
