// SPDX-License-Identifier: Apache-2.0
// From clusters to tiles: cull, order roughly front to back, and bin.
//
// Order only decides how much the hierarchical depth can hide, never the result. Whole clusters are ordered by 32
// slices of depth and keep their memory order within a slice: a full sort hides no more and loses locality.

#include "zbuffer/frame_plan.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/parallel.h"

namespace frontmost::zbuffer_detail {
namespace {

// A cluster on more tiles than this is cheaper taken apart than transformed again for each.
constexpr int kMaxTilesOfCluster = 16;
constexpr std::size_t kSlices = 32;

struct TileRect {
  int x0, y0, x1, y1;
  [[nodiscard]] int count() const { return (x1 - x0 + 1) * (y1 - y0 + 1); }
};

TileRect tiles_of(const PixelRect& rect) {
  return {rect.x0 / kTileSize, rect.y0 / kTileSize, rect.x1 / kTileSize, rect.y1 / kTileSize};
}

std::uint32_t bits_of(float key) {
  std::uint32_t bits;
  std::memcpy(&bits, &key, sizeof bits);
  return bits;
}

/// Lists of the tiles that `visit(item, add)` names by add(tile), items in their order: counted first, then filled.
template <class Visit>
void make_lists(const TileRange& tiles, std::size_t item_count, const Visit& visit, TileLists& lists) {
  lists.first_tile = tiles.begin;
  const std::size_t tile_count = tiles.end - tiles.begin;
  // One place behind, so that filling a list moves its beginning to where it belongs.
  lists.begin.assign(tile_count + 2, 0);
  for (std::size_t i = 0; i < item_count; ++i)
    visit(i, [&](std::size_t tile) { ++lists.begin[tile - tiles.begin + 2]; });
  for (std::size_t tile = 0; tile < tile_count; ++tile) lists.begin[tile + 2] += lists.begin[tile + 1];
  lists.items.resize(lists.begin[tile_count + 1]);
  for (std::size_t i = 0; i < item_count; ++i)
    visit(i, [&](std::size_t tile) {
      lists.items[lists.begin[tile - tiles.begin + 1]++] = static_cast<std::uint32_t>(i);
    });
}

/// Calls add(tile) for the tiles of `range` in which a record may be seen.
template <class Add>
void visit_tiles(const TriangleRecord& record, const View& view, int tiles_x, const TileRange& range, const Add& add) {
  const PixelRect rect = pixel_rect(record, view.width, view.height);
  if (rect.x1 < rect.x0 || rect.y1 < rect.y0) return;
  const TileRect tiles = tiles_of(rect);
  const int first_row = int(range.begin / std::size_t(tiles_x)), last_row = int((range.end - 1) / std::size_t(tiles_x));
  for (int y = std::max(tiles.y0, first_row); y <= std::min(tiles.y1, last_row); ++y)
    for (int x = tiles.x0; x <= tiles.x1; ++x) {
      const std::size_t tile = std::size_t(y) * std::size_t(tiles_x) + std::size_t(x);
      if (tile < range.begin || tile >= range.end) continue;
      const PixelRect pixels{x * kTileSize, y * kTileSize, (x + 1) * kTileSize - 1, (y + 1) * kTileSize - 1};
      if (tiles.count() == 1 || !misses(record, pixels)) add(tile);
    }
}

}  // namespace

void FramePlan::list_records(const TileRange& round, const View& view) {
  make_lists(
      round, records_.size(),
      [&](std::size_t i, const auto& add) { visit_tiles(records_[i], view, tiles_x_, round, add); }, record_lists_);
}

TileJob FramePlan::job(std::size_t tile, const View& view) const {
  TileJob job;
  job.x = int(tile % std::size_t(tiles_x_)) * kTileSize;
  job.y = int(tile / std::size_t(tiles_x_)) * kTileSize;
  job.width = std::min(kTileSize, view.width - job.x);
  job.height = std::min(kTileSize, view.height - job.y);
  job.records = record_lists_.of(tile);
  job.clusters = cluster_lists_.of(tile);
  return job;
}

void FramePlan::make(const ClusterSet& set, const ScreenTransform& transform, const View& view,
                     const Execution& execution, std::size_t most_record_items) {
  constexpr std::size_t kCullGrain = 4096;
  tiles_x_ = (view.width + kTileSize - 1) / kTileSize;
  tiles_y_ = (view.height + kTileSize - 1) / kTileSize;
  culled_.resize(set.clusters.size());
  const bool by_facing = view.culling == Culling::back || view.culling == Culling::front;
  const CullInput input{set.boxes, by_facing ? set.cones.get(set, execution) : nullptr, transform, view};
  parallel_for(execution, set.clusters.size(), kCullGrain, [&](std::size_t begin, std::size_t end) {
    cull_clusters(input, execution.isa, {begin, end}, culled_);
  });
  // What may have holes is drawn afterwards: cutout_pass.h.
  std::fill(culled_.fate.begin() + std::ptrdiff_t(set.first_cutout), culled_.fate.end(),
            static_cast<std::uint8_t>(ClusterFate::culled));
  choose_apart(set.clusters.size());
  take_apart(set, transform, view, execution);
  split_into_rounds(view, most_record_items);
  order_whole(set.clusters.size());
  list_clusters();
}

void FramePlan::choose_apart(std::size_t cluster_count) {
  apart_.clear();
  for (std::size_t i = 0; i < cluster_count; ++i) {
    if (culled_.fate_of(i) == ClusterFate::whole && tiles_of(culled_.rect(i)).count() > kMaxTilesOfCluster)
      culled_.fate[i] = static_cast<std::uint8_t>(ClusterFate::apart);
    if (culled_.fate_of(i) == ClusterFate::apart) apart_.push_back(static_cast<std::uint32_t>(i));
  }
}

void FramePlan::take_apart(const ClusterSet& set, const ScreenTransform& transform, const View& view,
                           const Execution& execution) {
  constexpr std::size_t kGrain = 64;
  const std::size_t part_count = (apart_.size() + kGrain - 1) / kGrain;
  if (apart_parts_.size() < part_count) apart_parts_.resize(part_count);
  parallel_for(execution, apart_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<TriangleRecord>& part = apart_parts_[begin / kGrain];
    part.clear();
    for (std::size_t i = begin; i < end; ++i) append_records(set, set.clusters[apart_[i]], transform, view, part);
  });
  records_.clear();
  for (std::size_t i = 0; i < part_count; ++i)
    records_.insert(records_.end(), apart_parts_[i].begin(), apart_parts_[i].end());
  std::sort(records_.begin(), records_.end(),
            [](const TriangleRecord& a, const TriangleRecord& b) { return a.nearest() > b.nearest(); });
}

/// Consecutive tiles whose lists together hold at most `most_items`, one tile at least.
void FramePlan::split_into_rounds(const View& view, std::size_t most_items) {
  const TileRange all{0, tile_count()};
  rounds_.assign(1, all);
  // Even if every record were in every tile: no need to count.
  if (records_.size() <= most_items / all.end) return;
  std::vector<std::uint32_t> counts(all.end, 0);
  for (const TriangleRecord& record : records_)
    visit_tiles(record, view, tiles_x_, all, [&](std::size_t tile) { ++counts[tile]; });
  rounds_.assign(1, {0, 0});
  std::size_t items = 0;
  for (std::size_t tile = 0; tile < all.end; ++tile) {
    if (items + counts[tile] > most_items && rounds_.back().end > rounds_.back().begin) {
      rounds_.push_back({tile, tile});
      items = 0;
    }
    items += counts[tile];
    rounds_.back().end = tile + 1;
  }
}

void FramePlan::order_whole(std::size_t cluster_count) {
  // By the bits of the key, which grow with its logarithm: slices grow with the distance, as what is behind does.
  std::uint32_t least = 0xFFFFFFFFu, greatest = 0;
  for (std::size_t i = 0; i < cluster_count; ++i) {
    if (culled_.fate_of(i) != ClusterFate::whole) continue;
    least = std::min(least, bits_of(culled_.nearest[i]));
    greatest = std::max(greatest, bits_of(culled_.nearest[i]));
  }
  const double scale = greatest > least ? double(kSlices - 1) / double(greatest - least) : 0.0;
  const auto slice_of = [&](std::size_t i) {
    return std::size_t(double(greatest - bits_of(culled_.nearest[i])) * scale);
  };

  std::array<std::size_t, kSlices + 1> begin{};
  for (std::size_t i = 0; i < cluster_count; ++i)
    if (culled_.fate_of(i) == ClusterFate::whole) ++begin[slice_of(i) + 1];
  for (std::size_t s = 0; s < kSlices; ++s) begin[s + 1] += begin[s];
  order_.resize(begin[kSlices]);
  for (std::size_t i = 0; i < cluster_count; ++i)
    if (culled_.fate_of(i) == ClusterFate::whole) order_[begin[slice_of(i)]++] = static_cast<std::uint32_t>(i);
}

void FramePlan::list_clusters() {
  const auto visit = [&](std::size_t i, const auto& add) {
    const TileRect tiles = tiles_of(culled_.rect(order_[i]));
    for (int y = tiles.y0; y <= tiles.y1; ++y)
      for (int x = tiles.x0; x <= tiles.x1; ++x) add(std::size_t(y) * std::size_t(tiles_x_) + std::size_t(x));
  };
  make_lists({0, tile_count()}, order_.size(), visit, cluster_lists_);
  for (std::uint32_t& item : cluster_lists_.items) item = order_[item];
}

}  // namespace frontmost::zbuffer_detail
