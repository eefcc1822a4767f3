// SPDX-License-Identifier: Apache-2.0
// Ray casting: tiles of rays, on all threads.
//
// A picture is cast in tiles of 32 x 32 pixels. A part is a few neighbouring tiles, so that threads share the nodes
// that they fetch. The RayCaster keeps planes and scratch memory from picture to picture.

#include "frontmost/raycast.h"

#include <atomic>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "raycast/tile/tile_kernel.h"

namespace frontmost {
namespace {

using namespace raycast_detail;

/// The greatest |position - eye| in the tree, by axis, which bounds the rounding of a box's distance to a plane.
glm::vec3 reach_of(const Box& bounds, const ScreenTransform& t) {
  if (bounds.is_empty()) return glm::vec3(0);
  const glm::vec3 eye(t.eye[0], t.eye[1], t.eye[2]);
  return glm::max(glm::abs(bounds.low - eye), glm::abs(bounds.high - eye));
}

}  // namespace

struct RayCaster::State {
  Pool<RayTileScratch> scratches;
  Visible visible;

  /// Makes planes for the view, or keeps the last ones if they fit. \returns true if their memory was used before.
  bool prepare_planes(const View& view) {
    const bool fits = visible.primitives.size() == view.sample_count();
    // If memory suffices for one plane only, neither may stay, as `fits` looks at one alone.
    if (!fits) {
      visible = {};
      visible = {view, Buffer<PrimitiveId>(view.sample_count()), Buffer<float>(view.sample_count())};
    }
    visible.view = view;
    return fits;
  }
};

RayCaster::RayCaster() : state_(std::make_unique<State>()) {}
RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

const Visible& RayCaster::draw(const RayIndex& index, const View& view, const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  const RayTree& tree = ray_tree(index);
  const ScreenTransform transform(view);
  const bool is_used = state_->prepare_planes(view);
  Visible& visible = state_->visible;
  const RayTileInput frame{tree,
                           transform,
                           view,
                           FacingRule(view.culling, tree.sides.get()),
                           sample_offsets(view.samples),
                           reach_of(tree.bounds, transform),
                           visible.primitives.data(),
                           visible.keys.data(),
                           is_used};
  const int tiles_x = (view.width + kTileSize - 1) / kTileSize, tiles_y = (view.height + kTileSize - 1) / kTileSize;
  const std::size_t tiles = std::size_t(tiles_x) * std::size_t(tiles_y);
  std::atomic<std::size_t> done{0};
  // A part has several tiles: tiles of 32 pixels are so small that threads would wait for each other, and neighbours
  // share the contents of the caches.
  constexpr std::size_t kTilesPerPart = 4;
  parallel_for(execution, tiles, kTilesPerPart, [&](std::size_t begin, std::size_t end) {
    const auto scratch = state_->scratches.borrow([] { return std::make_unique<RayTileScratch>(); });
    scratch->reserve(tree);
    for (std::size_t i = begin; i < end; ++i)
      cast_tile(frame, int(i % std::size_t(tiles_x)), int(i / std::size_t(tiles_x)), *scratch, execution.isa);
    report_progress(execution, "visible", double(done += end - begin) / double(tiles));
  });
  pass_holes(tree, visible, execution);
  return visible;
}

Visible RayCaster::take() { return std::move(state_->visible); }

Visible raycast(const RayIndex& index, const View& view, const Execution& execution) {
  RayCaster caster;
  caster.draw(index, view, execution);
  return caster.take();
}

Visible raycast(const Surfaces& surfaces, const View& view, const Execution& execution) {
  validate(view);
  return raycast(RayIndex(surfaces, execution), view, execution);
}

}  // namespace frontmost
