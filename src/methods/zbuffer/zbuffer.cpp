// SPDX-License-Identifier: Apache-2.0
// The z-buffer: plan the frame, then draw its tiles on all threads.
//
// The order of drawing decides how much the hierarchical depth can hide, but never the result. Clusters that are drawn
// whole are sorted into 32 slices of depth and keep their memory order within a slice, because a full sort hides no
// more and loses locality.
//
// A ZBuffer keeps its planes, its plan and its scratch memory from frame to frame. Tiles that stay empty are not filled
// again: `blank` tells which tiles of the planes hold nothing. If an error ends a frame, the tiles being drawn count as
// not blank.

#include "frontmost/zbuffer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "surfaces/cluster_set.h"
#include "zbuffer/direct/direct_frame.h"
#include "zbuffer/frame_plan.h"
#include "zbuffer/triangle_records.h"

namespace frontmost {
namespace zbuffer_detail {
namespace {

// A cluster on more tiles than this is taken apart, because transforming it again for each tile costs more.
constexpr int kMaxTilesOfCluster = 16;
constexpr std::size_t kSlices = 32;

}  // namespace

TileJob FramePlan::job(std::size_t tile, const View& view) const {
  const PartedList records = records_.of(tile);
  const PartedList clusters(cluster_lists_.of(tile), [&](std::uint32_t cluster) { return cluster >= first_cutout_; });
  return {Tile(tile, view), {records.solid, clusters.solid}, {records.cutouts, clusters.cutouts}};
}

void FramePlan::make(const ClusterSet& set, const PlaceTarget& target, const Execution& execution,
                     std::size_t most_record_items) {
  constexpr std::size_t kCullGrain = 4096;
  culled_.resize(set.clusters.size());
  const View& view = target.view;
  const Culling culling = target.facing.culling();
  const ConeArrays* cones = nullptr;
  if (culling == Culling::back || culling == Culling::front) {
    // In each frame, cones save between 1/40 and 1/2 of what making them costs, so they are made after some frames
    // without.
    constexpr int kFramesWithout = 8;
    const std::weak_ptr<const void> identity = set.cones.identity();
    if (identity.owner_before(last_set_) || last_set_.owner_before(identity)) {
      last_set_ = identity;
      frames_by_facing_ = 0;
    }
    cones = frames_by_facing_++ < kFramesWithout ? set.cones.made() : &set.cones.get(set, execution);
  }
  const CullInput input{set.boxes, cones, target.transform, view};
  parallel_for(execution, set.clusters.size(), kCullGrain, [&](std::size_t begin, std::size_t end) {
    cull_clusters(input, execution.isa, {begin, end}, culled_);
  });
  first_cutout_ = set.first_cutout;
  choose_apart(set.clusters.size());
  take_apart(set, target, execution);
  records_.plan(view, set.cutouts.get(), most_record_items);
  order_whole(set.clusters.size());
  list_clusters(view);
}

void FramePlan::choose_apart(std::size_t cluster_count) {
  apart_.clear();
  for (std::size_t i = 0; i < cluster_count; ++i) {
    if (culled_.fate_of(i) == ClusterFate::whole && TileRect(culled_.rect(i)).count() > kMaxTilesOfCluster)
      culled_.fate[i] = static_cast<std::uint8_t>(ClusterFate::apart);
    if (culled_.fate_of(i) == ClusterFate::apart) apart_.push_back(static_cast<std::uint32_t>(i));
  }
}

void FramePlan::take_apart(const ClusterSet& set, const PlaceTarget& target, const Execution& execution) {
  constexpr std::size_t kGrain = 64;
  const std::size_t part_count = (apart_.size() + kGrain - 1) / kGrain;
  if (apart_parts_.size() < part_count) apart_parts_.resize(part_count);
  parallel_for(execution, apart_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    // Parts belong to chunks, not threads, so the order of records does not depend on the number of threads.
    std::vector<TriangleRecord>& part = apart_parts_[begin / kGrain];
    part.clear();
    for (std::size_t i = begin; i < end; ++i) append_records(target, set, set.clusters[apart_[i]], part);
  });
  std::vector<TriangleRecord>& all = records_.records;
  all.clear();
  for (std::size_t i = 0; i < part_count; ++i) all.insert(all.end(), apart_parts_[i].begin(), apart_parts_[i].end());
}

void FramePlan::order_whole(std::size_t cluster_count) {
  // Slices divide the range of the keys' bits evenly. The bits grow with the logarithm of the key, so slices get deeper
  // with distance.
  std::uint32_t least = 0xFFFFFFFFu, greatest = 0;
  for (std::size_t i = 0; i < cluster_count; ++i) {
    if (culled_.fate_of(i) != ClusterFate::whole) continue;
    least = std::min(least, bits_as<std::uint32_t>(culled_.nearest[i]));
    greatest = std::max(greatest, bits_as<std::uint32_t>(culled_.nearest[i]));
  }
  const double scale = greatest > least ? double(kSlices - 1) / double(greatest - least) : 0.0;
  const auto slice_of = [&](std::size_t i) {
    return std::size_t(double(greatest - bits_as<std::uint32_t>(culled_.nearest[i])) * scale) +
           (i < first_cutout_ ? 0 : kSlices);
  };

  std::array<std::size_t, 2 * kSlices + 1> begin{};
  for (std::size_t i = 0; i < cluster_count; ++i)
    if (culled_.fate_of(i) == ClusterFate::whole) ++begin[slice_of(i) + 1];
  for (std::size_t s = 0; s < 2 * kSlices; ++s) begin[s + 1] += begin[s];
  order_.resize(begin.back());
  for (std::size_t i = 0; i < cluster_count; ++i)
    if (culled_.fate_of(i) == ClusterFate::whole) order_[begin[slice_of(i)]++] = static_cast<std::uint32_t>(i);
}

void FramePlan::list_clusters(const View& view) {
  const std::size_t across = Tile::tiles_across(view);
  cluster_lists_.make({0, Tile::count(view)}, order_.size(), [&](std::size_t i, const auto& add) {
    const TileRect tiles(culled_.rect(order_[i]));
    for (int y = tiles.y0; y <= tiles.y1; ++y)
      for (int x = tiles.x0; x <= tiles.x1; ++x) add(std::size_t(y) * across + std::size_t(x));
  });
  for (std::uint32_t& item : cluster_lists_.items) item = order_[item];
}

}  // namespace zbuffer_detail

using namespace zbuffer_detail;

struct ZBuffer::State {
  FramePlan plan;
  Pool<TileScratch> scratches;
  Visible visible;
  /// One entry a tile: 1 if nothing is seen in the tile's part of the planes. Such a tile need not be filled again if
  /// it stays empty and the grid of tiles stays the same.
  std::vector<std::uint8_t> blank;

  /// Makes planes for the view, or keeps those of the last frame if they fit. \returns true if their memory was used
  /// before.
  bool prepare_planes(const View& view) {
    const View& last = visible.view;
    const bool fits = visible.primitives.size() == view.sample_count() && visible.keys.size() == view.sample_count();
    // If memory runs out, planes, their view and `blank` still match each other.
    if (!fits) {
      visible = {};
      visible = {view, Buffer<PrimitiveId>(view.sample_count()), Buffer<float>(view.sample_count())};
      blank.clear();
    }
    if (last.width != view.width || last.height != view.height || last.samples != view.samples) blank.clear();
    if (blank.empty()) blank.assign(Tile::count(view), 0);
    visible.view = view;
    return fits;
  }
};

ZBuffer::ZBuffer() : state_(std::make_unique<State>()) {}
ZBuffer::~ZBuffer() = default;
ZBuffer::ZBuffer(ZBuffer&&) noexcept = default;
ZBuffer& ZBuffer::operator=(ZBuffer&&) noexcept = default;

const Visible& ZBuffer::draw(const Surfaces& surfaces, const View& view, const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  const ClusterSet& set = cluster_set(surfaces, execution);
  const ScreenTransform transform(view);
  FramePlan& plan = state_->plan;
  const PlaceTarget target(transform, view, placed_scene(surfaces).sides.get(), execution.isa);
  plan.make(set, target, execution);

  // Streaming to planes that are touched for the first time costs 20 % at 16 MiB and saves 15 % at 66 MiB. On planes
  // that were written before, streaming pays off from the size at which they leave the second-level cache.
  const std::size_t stream_from = std::size_t(state_->prepare_planes(view) ? 2 : 32) << 20;
  const bool streams = view.sample_count() * (sizeof(PrimitiveId) + sizeof(float)) >= stream_from;
  Visible& visible = state_->visible;
  const Picture picture{view,
                        sample_offsets(view.samples),
                        visible.primitives.data(),
                        visible.keys.data(),
                        streams,
                        set.cutouts.get(),
                        ScreenRays(view),
                        nullptr};
  const FrameInput frame{picture, set, transform, target.facing, plan.culled(), plan.records().records};
  std::atomic<std::size_t> drawn{0};
  draw_tiles(plan.records(), view, execution, state_->scratches, [&](std::size_t tile, TileScratch& scratch) {
    const TileJob job = plan.job(tile, view);
    std::uint8_t& blank = state_->blank[tile];
    if (!blank || !job.is_empty()) {
      blank = 0;  // not blank while the tile is being drawn: an error may end the frame here
      draw_tile(frame, job, scratch, execution.isa);
      blank = job.is_empty();
    }
    report_progress(execution, "visible", double(++drawn) / double(Tile::count(view)));
  });
  return visible;
}

Visible ZBuffer::take() { return std::move(state_->visible); }

void ZBuffer::give_back(Visible&& planes) {
  state_->visible = std::move(planes);
  state_->blank.clear();  // the planes may hold anything now
}

Visible zbuffer(const Surfaces& surfaces, const View& view, const Execution& execution) {
  validate(view);
  if (!made_cluster_set(surfaces)) {
    const IeeeScope ieee;
    return draw_directly(placed_scene(surfaces), view, execution);
  }
  ZBuffer buffer;
  buffer.draw(surfaces, view, execution);
  return buffer.take();
}

VisiblePixels zbuffer_pixels(const Surfaces& surfaces, const View& view, const Execution& execution) {
  validate(view);
  if (!made_cluster_set(surfaces)) {
    const IeeeScope ieee;
    return draw_pixels_directly(placed_scene(surfaces), view, execution);
  }
  ZBuffer buffer;
  return pixels_of(buffer.draw(surfaces, view, execution));
}

}  // namespace frontmost
