// SPDX-License-Identifier: Apache-2.0
// All lists of a view as one piece of data.

#include "frontmost/abuffer.h"

#include <atomic>
#include <cmath>
#include <mutex>

#include "abuffer/fragment_lists.h"
#include "abuffer/options.h"
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
    by_material.push_back(m.alpha == Material::Alpha::opaque ? value : -value);
    differ = differ || by_material.back() != opacity;
  }
  if (!differ) return;
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

namespace {

using namespace abuffer_detail;

/// The lists of one job, until all are known.
struct Part {
  Rectangle pixels;
  JobLists lists;
};

/// Where each pixel's list begins, and the end of the last.
Buffer<std::uint64_t> beginnings(const View& view, const std::vector<Part>& parts) {
  Buffer<std::uint64_t> first(view.pixel_count() + 1, 0);
  for (const Part& part : parts)
    for (int y = 0; y < part.pixels.height; ++y)
      for (int x = 0; x < part.pixels.width; ++x) {
        const std::size_t at =
            std::size_t(part.pixels.y + y) * std::size_t(view.width) + std::size_t(part.pixels.x + x);
        const std::size_t p = std::size_t(y) * std::size_t(part.pixels.width) + std::size_t(x);
        first[at + 1] = part.lists.begin[p + 1] - part.lists.begin[p];
      }
  for (std::size_t i = 0; i < view.pixel_count(); ++i) first[i + 1] += first[i];
  return first;
}

void copy_rows(const Part& part, FragmentLists& lists) {
  const auto width = std::size_t(part.pixels.width);
  for (std::size_t y = 0; y < std::size_t(part.pixels.height); ++y) {
    const std::size_t at =
        (std::size_t(part.pixels.y) + y) * std::size_t(lists.view.width) + std::size_t(part.pixels.x);
    const std::uint32_t begin = part.lists.begin[y * width], end = part.lists.begin[(y + 1) * width];
    std::copy(part.lists.fragments.begin() + begin, part.lists.fragments.begin() + end,
              lists.fragments.begin() + std::ptrdiff_t(lists.first[at]));
  }
}

}  // namespace

FragmentLists abuffer(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                      const Execution& execution) {
  validate(view);
  validate(options);
  const IeeeScope ieee;
  const SamplePattern pattern = sample_pattern(view, options.grid);
  const FramePlan plan(surfaces, view, execution);
  const FrameInput frame{plan, pattern, false, execution.isa};
  const Opacities opacities(surfaces, options.opacity, execution);
  std::mutex mutex;
  std::vector<Part> parts;
  std::uint64_t total = 0;
  visit_tiles(frame, execution, [&](const TileJob& job, TileScratch* scratch) {
    if (!scratch) return;
    Part part{job.pixels, list_fragments(frame, job, *scratch, opacities)};
    const std::lock_guard lock(mutex);
    total += part.lists.fragments.size();
    if (total > max_fragments) throw Error(ErrorCode::limit_exceeded, "abuffer: more than 2^30 fragments");
    parts.push_back(std::move(part));
  });
  FragmentLists lists{view, pattern.positions(), beginnings(view, parts), {}};
  lists.fragments.resize(total);
  constexpr std::size_t kGrain = 16;
  parallel_for(execution, parts.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      copy_rows(parts[i], lists);
      parts[i].lists = {};
    }
  });
  return lists;
}

}  // namespace frontmost
