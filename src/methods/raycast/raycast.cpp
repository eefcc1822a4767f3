// SPDX-License-Identifier: Apache-2.0
// Ray casting: casts tiles of rays on all threads, and then casts the rays that ended in holes again.
//
// A picture is cast in tiles of 32 x 32 pixels. A thread casts a few neighbouring tiles at a time, because neighbours
// visit the same nodes. The RayCaster keeps planes and scratch memory from picture to picture.

#include "frontmost/raycast.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "raycast/tile/tile_kernel.h"
#include "view/screen_cutout.h"

namespace frontmost {
namespace {

using namespace raycast_detail;

/// Returns the greatest |position - eye| in the tree for each axis, which bounds the rounding of a box's distance to a
/// plane.
glm::vec3 reach_of(const Box& bounds, const ScreenTransform& t) {
  if (bounds.is_empty()) return glm::vec3(0);
  const glm::vec3 eye(t.eye[0], t.eye[1], t.eye[2]);
  return glm::max(glm::abs(bounds.low - eye), glm::abs(bounds.high - eye));
}

/// A place on the screen: the pixel, and its sample in 1/256 pixel from the image's top left.
struct SamplePlace {
  int pixel_x, pixel_y;
  std::int32_t x, y;
};

struct Nearest {
  PrimitiveId id = no_primitive;
  float key = 0;
};

/// Casts rays of one view through holes, one ray at a time, by the definition of sample_rule.h. Serves one thread. A
/// ray that continued from a hole would start at a rounded position. So the ray begins at the eye again and leaves out
/// every hit that lies in a hole. The nearest hit that remains is by definition the visible one. Boxes are tested in
/// doubles, padded by more than the rounding of a vertex's position.
class HolePasser {
 public:
  HolePasser(const RayTree& tree, const View& view)
      : tree_(tree),
        cutouts_(*tree.cutouts),
        view_(view),
        facing_(view.culling, tree.sides.get()),
        transform_(view),
        rays_(view) {}

  [[nodiscard]] bool is_hole(PrimitiveId id, const SamplePlace& place) {
    if (!cutouts_.has(id)) return false;
    // Neighbours mostly look at the same triangle, and setting up a cutout costs more than testing it.
    if (id != id_) {
      cutout_.emplace(cutouts_[id], rays_);
      id_ = id;
    }
    return cutout_->is_hole(place.x, place.y);
  }

  /// Returns the nearest hit that does not lie in a hole.
  [[nodiscard]] Nearest look(const SamplePlace& place) {
    const glm::dvec3 at = rays_.at(double(place.x) / kSubPixels, double(place.y) / kSubPixels);
    start_ = rays_.is_parallel() ? at : glm::dvec3(0);
    direction_ = rays_.is_parallel() ? rays_.forward() : at;
    nearest_ = {};
    waiting_.assign(1, {transform_.near, tree_.root});
    while (!waiting_.empty()) {
      const auto [enter, child] = waiting_.back();
      waiting_.pop_back();
      if (is_behind(enter)) continue;
      if (child & kLeafBit)
        meet_leaf(tree_.leaf(child), place);
      else
        look_into(tree_.nodes[child]);
    }
    return nearest_;
  }

 private:
  /// A child, and where the ray enters its box.
  struct Waiting {
    double enter;
    std::uint32_t child;
  };

  /// Pushes the children that the ray enters. The nearest child is popped first, because its triangles hide most of the
  /// others.
  void look_into(const RayNode& node) {
    const std::size_t others = waiting_.size();
    for (std::uint32_t i = 0; i < node.count; ++i) {
      glm::dvec3 low, high;
      for (int axis = 0; axis < 3; ++axis) low[axis] = node.low[axis][i], high[axis] = node.high[axis][i];
      if (const auto enter = entry(low - rays_.eye(), high - rays_.eye())) waiting_.push_back({*enter, node.child[i]});
    }
    std::sort(waiting_.begin() + std::ptrdiff_t(others), waiting_.end(),
              [](const Waiting& a, const Waiting& b) { return a.enter > b.enter; });
  }

  /// Returns whether everything from the distance `enter` on is behind the nearest hit so far.
  [[nodiscard]] bool is_behind(double enter) const {
    return !(enter <= transform_.near || key_of_distance(transform_, enter) * (1 + 0x1p-20f) >= nearest_.key);
  }

  /// Returns the distance at which the ray enters a box between the near and far planes; none if the ray misses the
  /// box, or if the box is behind the nearest hit so far. The box is relative to the eye. Distances are along the
  /// viewing axis.
  [[nodiscard]] std::optional<double> entry(const glm::dvec3& low, const glm::dvec3& high) const {
    const glm::dvec3 far = glm::max(glm::abs(low), glm::abs(high));
    const double pad = 0x1p-17 * std::max({far.x, far.y, far.z});
    if (!std::isfinite(pad)) return transform_.near;  // a box that reaches beyond the range of floats is visited
    double enter = transform_.near - pad, leave = transform_.far + pad;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = low[axis] - pad - start_[axis], b = high[axis] + pad - start_[axis], d = direction_[axis];
      // The ray lies between the two planes everywhere or nowhere. The division below would give NaN if it lies in one
      // of them.
      if (d == 0) {
        if (a > 0 || b < 0) return std::nullopt;
        continue;
      }
      enter = std::max(enter, std::min(a / d, b / d));
      leave = std::min(leave, std::max(a / d, b / d));
    }
    if (!(enter <= leave) || is_behind(enter)) return std::nullopt;
    return enter;
  }

  void meet_leaf(const RayLeaf& leaf, const SamplePlace& place) {
    for (std::size_t lane = 0; lane < kRayLanes && leaf.id[lane] != no_primitive; ++lane)
      meet(make_triangle(transform_, leaf.corners_of(lane)), leaf.id[lane], place);
  }

  void meet(const SampleTriangle& triangle, PrimitiveId id, const SamplePlace& place) {
    const float sx = float(place.x - transform_.centre_x), sy = float(place.y - transform_.centre_y);
    if (!keeps(facing_, id, facing(transform_, triangle.corners, sx, sy))) return;
    // By definition, the key depends on the tile (sample_rule.h).
    const auto tile_centre = [](int pixel, std::int32_t image_centre) {
      return float((pixel / kTileSize * kTileSize + kTileSize / 2) * kSubPixels - image_centre);
    };
    const float tx = tile_centre(place.pixel_x, transform_.centre_x);
    const float ty = tile_centre(place.pixel_y, transform_.centre_y);
    const TileKeyPlane plane = key_plane(view_, transform_, triangle, {tx, ty});
    const float raw = plane.raw(sx - tx, sy - ty);
    if (plane.is_outside || !plane.sees(raw)) return;
    const float key = plane.clamped(raw);
    const bool is_nearer = key > nearest_.key || (key == nearest_.key && id < nearest_.id);
    if (is_nearer && !is_hole(id, place)) nearest_ = {id, key};
  }

  const RayTree& tree_;
  const Cutouts& cutouts_;
  const View& view_;
  FacingRule facing_;
  ScreenTransform transform_;
  ScreenRays rays_;
  PrimitiveId id_ = no_primitive;  ///< triangle of cutout_
  std::optional<ScreenCutout> cutout_;
  // State of the current ray.
  glm::dvec3 start_{0}, direction_{0};  ///< start relative to the eye; direction with length 1 along the viewing axis
  Nearest nearest_;
  std::vector<Waiting> waiting_;
};

/// Completes a Visible that was cast as if no triangle had holes. At each sample that looks into a hole, the triangle
/// is replaced by the nearest hit that does not lie in a hole. O(samples), and at least O(log n) for each ray that is
/// cast again.
void pass_holes(const RayTree& tree, Visible& visible, const Execution& execution) {
  if (!tree.cutouts) return;
  const View& view = visible.view;
  const std::span<const glm::ivec2> samples = sample_offsets(view.samples);
  constexpr std::size_t kRowsPerPart = 4;
  const std::size_t height = std::size_t(view.height), rows = height * samples.size();
  parallel_for(execution, rows, kRowsPerPart, [&](std::size_t begin, std::size_t end) {
    HolePasser passer(tree, view);
    for (std::size_t row = begin; row < end; ++row)
      for (int x = 0; x < view.width; ++x) {
        const int y = int(row % height);
        const glm::ivec2 offset = samples[row / height];
        const SamplePlace place{x, y, x * kSubPixels + offset.x, y * kSubPixels + offset.y};
        const std::size_t i = row * std::size_t(view.width) + std::size_t(x);
        if (visible.primitives[i] == no_primitive || !passer.is_hole(visible.primitives[i], place)) continue;
        const Nearest next = passer.look(place);
        visible.primitives[i] = next.id;
        visible.keys[i] = next.key;
      }
  });
}

}  // namespace

struct RayCaster::State {
  Pool<RayTileScratch> scratches;
  Visible visible;

  /// Makes planes for the view, or keeps the last ones if they fit. \returns true if their memory was used before.
  bool prepare_planes(const View& view) {
    const bool fits = visible.primitives.size() == view.sample_count();
    // If memory suffices for one plane only, neither may stay, because `fits` tests one plane alone.
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
  // A thread casts several tiles at a time. Single tiles of 32 pixels are so small that threads would wait for each
  // other, and neighbouring tiles share the contents of the caches.
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
