// SPDX-License-Identifier: Apache-2.0
#include "shade/geometry/geometry.h"

#include <algorithm>

#include "base/parallel.h"

namespace frontmost::shading {
namespace {

/// Without branches, so that the compiler can compare many at a time.
bool all_equal(const PrimitiveId* ids, std::size_t count, PrimitiveId id) {
  PrimitiveId different = 0;
  for (std::size_t i = 0; i < count; ++i) different |= ids[i] ^ id;
  return different == 0;
}

bool any_seen(const BitSet& seen, PrimitiveId first, std::size_t count) {
  for (std::size_t t = 0; t < count; ++t)
    if (seen.contains(first + t)) return true;
  return false;
}

}  // namespace

BitSet seen_primitives(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  BitSet seen(surfaces.primitive_count());
  constexpr std::size_t samples_at_once = 1u << 16, run = 64;
  parallel_for(execution, visible.primitives.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    PrimitiveId last = no_primitive;
    for (std::size_t first = begin; first < end; first += run) {
      const std::size_t count = std::min(run, end - first);
      if (all_equal(visible.primitives.data() + first, count, last)) continue;
      for (std::size_t i = first; i < first + count; ++i) {
        const PrimitiveId id = visible.primitives[i];
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
  BitSet large = std::move(memory);
  large.clear(primitive_count);
  const View& view = visible.view;
  parallel_for(execution, std::size_t(view.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const PrimitiveId* row = visible.primitives.data() + visible.index(0, int(y));
      const auto is_at = [&](PrimitiveId id, int x, int up) {
        return x >= 0 && std::size_t(up) <= y && row[x - up * view.width] == id;
      };
      PrimitiveId last = no_primitive;
      for (int x = 0; x < view.width; ++x) {
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

std::vector<bool> seen_materials(const Surfaces& surfaces, const BitSet& seen, const Execution& execution) {
  const Scene& scene = surfaces.scene();
  BitSet materials(scene.materials.size());
  const auto add = [&](std::uint32_t material) {
    if (material != no_index) materials.add(material);
  };
  parallel_for(execution, scene.instances.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
      const PrimitiveId first = surfaces.first_primitive(std::uint32_t(i));
      if (mesh.material_ids.size() <= 1) {
        if (!mesh.material_ids.empty() && any_seen(seen, first, mesh.triangles.size())) add(mesh.material_ids[0]);
      } else {
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
          if (seen.contains(first + t)) add(mesh.material_of(t));
      }
    }
  });
  std::vector<bool> result(scene.materials.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = materials.contains(i);
  return result;
}

}  // namespace frontmost::shading
