// SPDX-License-Identifier: Apache-2.0
// From clusters to tiles: cull, order roughly front to back, and bin.
//
// Order only decides how much the hierarchical depth can hide, never the result. Whole clusters are ordered by 32
// slices of depth and keep their memory order within a slice: a full sort hides no more and loses locality.

#include "zbuffer/frame_plan.h"

#include <algorithm>
#include <array>

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

/// Lists of the tiles that `visit(item, add)` names by add(tile), items in their order: counted first, then filled.
template <class Visit>
TileLists make_lists(const TileRange& tiles, std::size_t item_count, const Visit& visit) {
  TileLists lists;
  lists.first_tile = tiles.begin;
  const std::size_t tile_count = tiles.end - tiles.begin;
  lists.begin.assign(tile_count + 1, 0);
  for (std::size_t i = 0; i < item_count; ++i)
    visit(i, [&](std::size_t tile) { ++lists.begin[tile - tiles.begin + 1]; });
  for (std::size_t tile = 0; tile < tile_count; ++tile) lists.begin[tile + 1] += lists.begin[tile];
  lists.items.resize(lists.begin[tile_count]);
  std::vector<std::size_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for (std::size_t i = 0; i < item_count; ++i)
    visit(i, [&](std::size_t tile) { lists.items[next[tile - tiles.begin]++] = static_cast<std::uint32_t>(i); });
  return lists;
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

/// Consecutive tiles whose lists together hold at most `most_items`, one tile at least.
std::vector<TileRange> split_into_rounds(const FramePlan& plan, const View& view, std::size_t most_items) {
  const TileRange all{0, plan.tile_count()};
  // Even if every record were in every tile: no need to count.
  if (plan.records.size() <= most_items / all.end) return {all};
  std::vector<std::uint32_t> counts(all.end, 0);
  for (const TriangleRecord& record : plan.records)
    visit_tiles(record, view, plan.tiles_x, all, [&](std::size_t tile) { ++counts[tile]; });
  std::vector<TileRange> rounds{{0, 0}};
  std::size_t items = 0;
  for (std::size_t tile = 0; tile < all.end; ++tile) {
    if (items + counts[tile] > most_items && rounds.back().end > rounds.back().begin) {
      rounds.push_back({tile, tile});
      items = 0;
    }
    items += counts[tile];
    rounds.back().end = tile + 1;
  }
  return rounds;
}

std::vector<TriangleRecord> take_apart(const ClusterSet& set, const ScreenTransform& transform, const View& view,
                                       const std::vector<std::uint32_t>& apart, const Execution& execution) {
  constexpr std::size_t kGrain = 64;
  std::vector<std::vector<TriangleRecord>> parts((apart.size() + kGrain - 1) / kGrain);
  parallel_for(execution, apart.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      append_records(set, set.clusters[apart[i]], transform, view.culling, parts[begin / kGrain]);
  });
  std::vector<TriangleRecord> records;
  std::size_t count = 0;
  for (const std::vector<TriangleRecord>& part : parts) count += part.size();
  records.reserve(count);
  for (std::vector<TriangleRecord>& part : parts) {
    records.insert(records.end(), part.begin(), part.end());
    std::vector<TriangleRecord>().swap(part);
  }
  std::stable_sort(records.begin(), records.end(),
                   [](const TriangleRecord& a, const TriangleRecord& b) { return a.nearest() > b.nearest(); });
  return records;
}

/// The clusters drawn whole, nearer slices first.
std::vector<std::uint32_t> order_whole(const CullResult& culled, std::size_t cluster_count) {
  float least = std::numeric_limits<float>::infinity(), greatest = 0;
  for (std::size_t i = 0; i < cluster_count; ++i) {
    if (culled.fate_of(i) != ClusterFate::whole) continue;
    least = std::min(least, culled.nearest[i]);
    greatest = std::max(greatest, culled.nearest[i]);
  }
  // In double: keys may be denormal floats, whose reciprocal is not a float.
  const double scale = greatest > least ? double(kSlices - 1) / (double(greatest) - least) : 0.0;
  const auto slice_of = [&](std::size_t i) { return std::size_t((double(greatest) - culled.nearest[i]) * scale); };

  std::array<std::size_t, kSlices + 1> begin{};
  for (std::size_t i = 0; i < cluster_count; ++i)
    if (culled.fate_of(i) == ClusterFate::whole) ++begin[slice_of(i) + 1];
  for (std::size_t s = 0; s < kSlices; ++s) begin[s + 1] += begin[s];
  std::vector<std::uint32_t> order(begin[kSlices]);
  for (std::size_t i = 0; i < cluster_count; ++i)
    if (culled.fate_of(i) == ClusterFate::whole) order[begin[slice_of(i)]++] = static_cast<std::uint32_t>(i);
  return order;
}

}  // namespace

TileLists FramePlan::record_lists(const TileRange& round, const View& view) const {
  return make_lists(round, records.size(),
                    [&](std::size_t i, const auto& add) { visit_tiles(records[i], view, tiles_x, round, add); });
}

TileJob FramePlan::job(std::size_t tile, const View& view, const TileLists& record_lists) const {
  TileJob job;
  job.x = int(tile % std::size_t(tiles_x)) * kTileSize;
  job.y = int(tile / std::size_t(tiles_x)) * kTileSize;
  job.width = std::min(kTileSize, view.width - job.x);
  job.height = std::min(kTileSize, view.height - job.y);
  job.records = record_lists.of(tile);
  job.clusters = cluster_lists.of(tile);
  return job;
}

FramePlan plan_frame(const ClusterSet& set, const ScreenTransform& transform, const View& view,
                     const Execution& execution, std::size_t most_record_items) {
  constexpr std::size_t kCullGrain = 4096;
  FramePlan plan;
  plan.tiles_x = (view.width + kTileSize - 1) / kTileSize;
  plan.tiles_y = (view.height + kTileSize - 1) / kTileSize;
  const std::size_t count = set.clusters.size(), tiles_x = std::size_t(plan.tiles_x);
  plan.culled.resize(count);
  parallel_for(execution, count, kCullGrain, [&](std::size_t begin, std::size_t end) {
    cull_clusters(set.boxes, transform, view, execution.isa, begin, end, plan.culled);
  });

  std::vector<std::uint32_t> apart;
  for (std::size_t i = 0; i < count; ++i) {
    const ClusterFate fate = plan.culled.fate_of(i);
    if (fate == ClusterFate::whole && tiles_of(plan.culled.rect(i)).count() > kMaxTilesOfCluster)
      plan.culled.fate[i] = static_cast<std::uint8_t>(ClusterFate::apart);
    if (plan.culled.fate_of(i) == ClusterFate::apart) apart.push_back(static_cast<std::uint32_t>(i));
  }
  plan.records = take_apart(set, transform, view, apart, execution);
  plan.rounds = split_into_rounds(plan, view, most_record_items);

  const std::vector<std::uint32_t> order = order_whole(plan.culled, count);
  plan.cluster_lists = make_lists({0, plan.tile_count()}, order.size(), [&](std::size_t i, const auto& add) {
    const TileRect tiles = tiles_of(plan.culled.rect(order[i]));
    for (int y = tiles.y0; y <= tiles.y1; ++y)
      for (int x = tiles.x0; x <= tiles.x1; ++x) add(std::size_t(y) * tiles_x + std::size_t(x));
  });
  for (std::uint32_t& item : plan.cluster_lists.items) item = order[item];
  return plan;
}

}  // namespace frontmost::zbuffer_detail
