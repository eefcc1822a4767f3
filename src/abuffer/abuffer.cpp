// SPDX-License-Identifier: Apache-2.0
// All lists of a view as one piece of data.

#include "frontmost/abuffer.h"

#include <atomic>
#include <cmath>
#include <mutex>

#include "abuffer/fragment_lists.h"
#include "abuffer/prepared_frame.h"
#include "abuffer/tile_parts.h"
#include "abuffer/visit_tiles.h"
#include "base/float_environment.h"

namespace frontmost {
namespace abuffer_detail {

void validate(const AbufferOptions& options) {
  if (!(options.opacity >= 0.0f && options.opacity <= 1.0f))
    throw Error(ErrorCode::bad_argument, "abuffer: opacity: must be 0 to 1");
}

Opacities::Opacities(const Surfaces& surfaces, float opacity, const Execution& execution) : all_(opacity) {
  const Scene& scene = surfaces.scene();
  std::vector<float> by_material;
  bool differ = false;
  for (const Material& m : scene.materials) {
    float value = opacity;
    if (m.alpha == Material::Alpha::blend) value *= m.base_color.a > 0 ? std::min(m.base_color.a, 1.0f) : 0.0f;
    // Even blended materials of opacity 1 may be seen through where their texture says so.
    by_material.push_back(m.alpha == Material::Alpha::blend ? -value : value);
    differ = differ || by_material.back() != opacity;
  }
  if (!differ) return;
  // Most scenes have one opacity for all and get here not at all: a number a primitive would be read for every
  // fragment.
  values_.assign(surfaces.primitive_count(), opacity);
  parallel_for(execution, scene.instances.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
      const PrimitiveId first = surfaces.first_primitive(std::uint32_t(i));
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::uint32_t material = mesh.material_of(t);
        if (material < by_material.size()) values_[first + t] = by_material[material];
      }
    }
  });
}

}  // namespace abuffer_detail

std::uint64_t most_gathered_fragments(const View& view) {
  constexpr std::uint64_t most_per_pixel = 64;
  return std::max(most_fragments, most_per_pixel * view.pixel_count());
}

FragmentLists abuffer(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                      const Execution& execution) {
  using namespace abuffer_detail;
  const IeeeScope ieee;
  const PreparedFrame prepared(surfaces, view, options, execution);
  const Opacities opacities(surfaces, options.opacity, execution);
  const CopyRule copies = copy_rule(opacities);
  const GatherInput frame = prepared.input(copies, execution);
  std::mutex mutex;
  std::vector<TilePart<Fragment>> parts;
  std::uint64_t total = 0;
  visit_tiles(frame, execution, [&](const GatherJob& job, GatherScratch* scratch) {
    if (!scratch) return;
    JobLists made = list_fragments(frame, job, *scratch, opacities);
    TilePart<Fragment> part{job.pixels, std::move(made.begin), std::move(made.fragments)};
    const std::lock_guard lock(mutex);
    total += part.items.size();
    // Only here the sum is known. Parts before this one are held already, but each was bounded by what a tile may hold.
    if (total > most_fragments) throw Error(ErrorCode::limit_exceeded, "abuffer: more than 2^30 fragments");
    parts.push_back(std::move(part));
  });
  FragmentLists lists{view, prepared.pattern.positions(), beginnings(view, parts), {}};
  lists.fragments.resize(total);
  constexpr std::size_t kGrain = 16;
  parallel_for(execution, parts.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      place_items(parts[i], view, lists.first, [&](std::uint64_t at, const Fragment& f) { lists.fragments[at] = f; });
      parts[i] = {};
    }
  });
  return lists;
}

FragmentCounts count_fragments(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                               const Execution& execution) {
  using namespace abuffer_detail;
  const IeeeScope ieee;
  const PreparedFrame prepared(surfaces, view, options, execution);
  const CopyRule all;
  const GatherInput frame = prepared.input(all, execution);
  std::mutex mutex;
  FragmentCounts counts;
  visit_tiles(frame, execution, [&](const GatherJob& /*job*/, const GatherScratch* scratch) {
    if (!scratch) return;
    std::size_t longest = 0;
    for (std::size_t group = 0; group < kGroups; ++group) longest = std::max(longest, scratch->length(group));
    const std::lock_guard lock(mutex);
    counts.fragments += scratch->arrived.count - Arrived::first;
    counts.longest = std::max(counts.longest, std::uint32_t(longest));
  });
  return counts;
}

}  // namespace frontmost
