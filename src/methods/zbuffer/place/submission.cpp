// SPDX-License-Identifier: Apache-2.0
// Batches of triangles: their lists by tile, and batches in the order of submission.
//
//    triangle    0     1     2     3     4          consecutive triangles that touch the same tiles are one run
//    tiles       A     A     A,B   A,B   B          runs of A: [0,1] [2,3]      runs of B: [2,3] [4]
//
// If triangles are scattered over the picture, every run has one triangle, and lists get as long as the batch. Such
// triangles are first sorted by their tiles. Sorting loses the order of submission, so it is left out for pictures
// that depend on this order.

#include "zbuffer/place/submission.h"

namespace frontmost::zbuffer_detail {
namespace {

/// BatchColumns::tiles, unpacked: at most two by two tiles.
struct SmallTiles {
  explicit SmallTiles(std::uint32_t t)
      : x0(int(t & 255)), y0(int(t >> 8 & 255)), x1(int(t >> 16 & 255)), y1(int(t >> 24)) {}
  int x0, y0, x1, y1;
};

}  // namespace

void TriangleBatch::clear() {
  constexpr std::int32_t kFar = 1 << 30;
  count = 0;
  rect = {kFar, kFar, -1, -1};
  nearest = 0;
}

TriangleRecord TriangleBatch::record(std::size_t i) const {
  const BatchColumns& c = columns();
  TriangleRecord record;
  record.id = c.id[i];
  for (int k = 0; k < 3; ++k) {
    record.x[k] = c.x[k][i];
    record.y[k] = c.y[k][i];
    record.key[k] = bits_as<float>(c.key[k][i]);
  }
  return record;
}

/// Calls visit(tiles, run) for each run. \returns the number of runs.
template <class Visit>
std::size_t TriangleBatch::visit_runs(const Visit& visit) const {
  const std::uint32_t* tiles = columns().tiles;
  std::size_t runs = 0;
  for (std::size_t i = 0; i < count; ++runs) {
    std::size_t end = i + 1;
    while (end < count && tiles[end] == tiles[i]) ++end;
    visit(SmallTiles(tiles[i]), TileRun{std::uint16_t(i), std::uint16_t(end - i)});
    i = end;
  }
  return runs;
}

void TriangleBatch::gather_strewn(Buffer<BatchColumns>& spare) {
  // If runs are shorter than this on average, drawing gathers them lane by lane, which costs more than sorting once.
  constexpr std::size_t kShortRun = 4;
  if (visit_runs([](const SmallTiles&, const TileRun&) {}) <= count / kShortRun) return;
  sort_by_tiles(spare[0]);
  columns_.swap(spare);
}

void TriangleBatch::list_tiles() {
  if (count == 0) return;
  const TileRect all = tiles();
  const int across = all.x1 - all.x0 + 1;
  const auto visit = [&](const auto& add) {
    visit_runs([&](const SmallTiles& tiles, const TileRun& run) {
      for (int y = tiles.y0; y <= tiles.y1; ++y)
        for (int x = tiles.x0; x <= tiles.x1; ++x) add(std::size_t((y - all.y0) * across + x - all.x0), run);
    });
  };
  const auto tile_count = std::size_t(all.count());
  // Filling a list advances its beginning, so beginnings are first stored one entry after their final place.
  begin_.assign(tile_count + 2, 0);
  visit([&](std::size_t tile, const TileRun&) { ++begin_[tile + 2]; });
  for (std::size_t tile = 0; tile < tile_count; ++tile) begin_[tile + 2] += begin_[tile + 1];
  runs_.resize(begin_[tile_count + 1]);
  visit([&](std::size_t tile, const TileRun& run) { runs_[begin_[tile + 1]++] = run; });
}

/// Sorts triangles by their first tile, then by whether they reach into the next column or row of tiles.
void TriangleBatch::sort_by_tiles(BatchColumns& sorted) {
  const TileRect all = tiles();
  const BatchColumns& from = columns();
  const auto place_of = [&](std::size_t i) {
    const SmallTiles t(from.tiles[i]);
    const int tile = (t.y0 - all.y0) * (all.x1 - all.x0 + 1) + t.x0 - all.x0;
    return 4 * std::size_t(tile) + std::size_t(2 * (t.y1 - t.y0) + (t.x1 - t.x0));
  };
  begin_.assign(4 * std::size_t(all.count()) + 1, 0);
  for (std::size_t i = 0; i < count; ++i) ++begin_[place_of(i) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t to = begin_[place_of(i)]++;
    from.copy_triangle(i, sorted, to);
  }
}

std::vector<BatchSource> batch_sources(std::span<const MeshRange> ranges) {
  std::vector<BatchSource> sources;
  std::size_t count = TriangleBatch::most_triangles;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const std::size_t more = ranges[i].count();
    if (count + more > TriangleBatch::most_triangles) {
      sources.push_back({i, i});
      count = 0;
    }
    count += more;
    sources.back().end = i + 1;
  }
  return sources;
}

void OrderedBatch::clear() {
  small_.clear();
  singles_.clear();
}

void OrderedBatch::place(const PlaceTarget& target, const WorldTriangles& triangles, PlaceScratch& scratch) {
  scratch.apart.clear();
  snap_vertices(target, triangles.positions, scratch.vertices);
  place_triangles(target, triangles, scratch.vertices, small_, scratch.apart);
  for (const std::uint32_t i : scratch.apart)
    append_single(target, polygon_of(target, triangles, scratch.vertices, i), triangles.first_id + i);
}

void OrderedBatch::list_tiles(const View& view) {
  small_.list_tiles();
  if (singles_.empty()) return;
  const TileRange all{0, Tile::count(view)};
  lists_.make(all, singles_.size(),
              [&](std::size_t i, const auto& add) { visit_tiles(singles_[i].record, view, all, add); });
}

void OrderedBatch::append_single(const PlaceTarget& target, const ClippedPolygon& polygon, PrimitiveId id) {
  if (polygon.count == 0) return;
  // `low` and `high` bound the keys of the whole polygon, not of a piece, because the polygon offset of f32 depends on
  // the primitive's greatest depth.
  float low = polygon.corners[0].key, high = low;
  for (int i = 0; i < polygon.count; ++i) {
    low = std::min(low, polygon.corners[std::size_t(i)].key);
    high = std::max(high, polygon.corners[std::size_t(i)].key);
  }
  for_each_of_fan(polygon, target.transform, id, [&](TriangleRecord& record) {
    if (orient(record, target.facing)) singles_.push_back({record, low, high});
  });
}

std::vector<MeshRange> ranges_within(const PlacedScene& placed, const PrimitiveRange& range) {
  std::vector<MeshRange> within;
  for (MeshRange part : placed.ranges) {
    const PrimitiveId first = placed.first_primitives[part.instance];
    if (range.end <= first + part.begin || range.begin >= first + part.end) continue;
    part.begin = std::max(part.begin, range.begin - std::min(range.begin, first));
    part.end = std::min(part.end, range.end - first);
    within.push_back(part);
  }
  return within;
}

std::size_t batches_at_once(const View& view) {
  constexpr std::size_t kMostItems = std::size_t(1) << 26;  // 256 MiB
  constexpr std::size_t kMost = 128;                        // 2^18 triangles
  // Clipping makes at most seven pieces of a triangle. Pieces do not overlap, so a tile touches one and a half of them
  // on average.
  return std::clamp<std::size_t>(kMostItems / (Tile::count(view) * MeshRange::most_triangles), 1, kMost);
}

}  // namespace frontmost::zbuffer_detail
