// SPDX-License-Identifier: Apache-2.0
// A tile that holds too many fragments is first thinned: invisible copies are left out. It is then halved along both
// axes until its parts have room; a part of one pixel always has room. Parts are whole blocks of 4 x 4 pixels as long
// as possible, because lists are sorted block by block.
//
//    64 x 64  --too much-->  copies out  --too much-->  four of 32 x 32  --too much-->  ...  --> one pixel
#include "abuffer/prepared_frame.h"

#include <atomic>

#include "base/parallel.h"
#include "base/pool.h"

namespace frontmost::abuffer_detail {
namespace {

/// The view, if it and the options are in range.
const View& valid(const View& view, const AbufferOptions& options) {
  validate(view);
  if (!(options.opacity >= 0.0f && options.opacity <= 1.0f))
    throw Error(ErrorCode::bad_argument, "abuffer: opacity", "must be 0 to 1");
  return view;
}

/// The share of light that passes below the surface, before any tint.
float limited_transmission(const Material& m) {
  if (m.unlit || !(m.transmission.factor > 0)) return 0;
  return std::min(m.transmission.factor, 1.0f) * (m.metallic > 0 ? 1 - std::min(m.metallic, 1.0f) : 1.0f);
}

/// Visits the tiles of a frame on one thread.
class TileVisitor {
 public:
  TileVisitor(GatherScratch& scratch, const PreparedFrame::Visit& visit) : scratch_(scratch), visit_(visit) {}

  /// \returns false if the rectangle has too many fragments at once; then nothing is visited.
  [[nodiscard]] bool visit_whole(const GatherInput& frame, const GatherJob& job) {
    const Gathered gathered = gather_tile(frame, job, scratch_);
    if (gathered == Gathered::too_much) return false;
    visit_(job.pixels, gathered == Gathered::something ? &scratch_ : nullptr);
    return true;
  }

  /// Visits the rectangle, or its parts.
  void visit_in_parts(const GatherInput& frame, const GatherJob& job) {
    if (visit_whole(frame, job)) return;
    // Parts are whole groups of pixels as long as there are groups.
    const Rectangle& r = job.pixels;
    const auto half = [](int size) { return size > 4 ? (size / 2 + 3) / 4 * 4 : (size + 1) / 2; };
    const int w = half(r.width), h = half(r.height);
    for (int y = 0; y < r.height; y += h)
      for (int x = 0; x < r.width; x += w)
        visit_in_parts(frame, {{r.x + x, r.y + y, std::min(w, r.width - x), std::min(h, r.height - y)}, job.tile});
  }

 private:
  GatherScratch& scratch_;
  const PreparedFrame::Visit& visit_;
};

}  // namespace

Opacities::Opacities(const Surfaces& surfaces, float opacity, const Execution& execution) : all_(opacity) {
  const IeeeScope ieee;
  const Scene& scene = surfaces.scene();
  std::vector<float> by_material;
  bool differ = false;
  for (const Material& m : scene.materials) {
    float value = opacity;
    if (m.alpha == Material::Alpha::blend) value *= m.base_color.a > 0 ? std::min(m.base_color.a, 1.0f) : 0.0f;
    if (m.is_see_through()) value *= 1 - limited_transmission(m);
    // Even blended materials of opacity 1 may be seen through where their texture says so.
    by_material.push_back(m.is_see_through() ? -value : value);
    differ = differ || by_material.back() != opacity;
  }
  if (!differ) return;
  // Most scenes have one opacity for all primitives and do not get here: a number for each primitive would be read for
  // every fragment.
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

PreparedFrame::PreparedFrame(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                             const Execution& execution)
    : pattern_(sample_pattern(valid(view, options), options.grid)), plan_(surfaces, view, execution) {}

void PreparedFrame::visit_tiles(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                                const Execution& execution) const {
  const IeeeScope ieee;
  std::atomic<std::size_t> done{0};
  const std::size_t tiles = plan_.tile_count();
  CrowdedFrame crowded(plan_, copies);
  Pool<GatherScratch> scratches;
  parallel_for(execution, tiles, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t tile = begin; tile < end; ++tile) {
      const GatherJob job{plan_.tile(tile), tile};
      if (leave_out && leave_out(job.pixels)) continue;
      const auto scratch = scratches.borrow([] { return std::make_unique<GatherScratch>(); });
      TileVisitor visitor(*scratch, visit);
      if (visitor.visit_whole({plan_, pattern_, execution.isa}, job)) continue;
      visitor.visit_in_parts({crowded.thinned(), pattern_, execution.isa}, job);
    }
    report_progress(execution, "visible", double(done += end - begin) / double(tiles));
  });
}

void PreparedFrame::visit_lists(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                                const Execution& execution) const {
  const GatherInput input{plan_, pattern_, execution.isa};
  const auto sort_and_visit = [&](const Rectangle& pixels, GatherScratch* fragments) {
    if (fragments) {
      sort_lists(execution.isa, *fragments);
      cut_fragments(input, pixels, *fragments);
    }
    visit(pixels, fragments);
  };
  visit_tiles(copies, sort_and_visit, leave_out, execution);
}

}  // namespace frontmost::abuffer_detail
