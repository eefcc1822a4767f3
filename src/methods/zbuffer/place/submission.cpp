// SPDX-License-Identifier: Apache-2.0
// From the scene's own arrays to triangles on the screen, in the order of their ids.
//
// A batch is placed in one call for each range of a mesh that it holds. Large or clipped triangles are singles with
// lists of their own. In a tile with singles, runs of small triangles are split at the singles' ids, so that all come
// in the order of submission.

#include "zbuffer/place/submission.h"

#include "zbuffer/record_lists.h"

namespace frontmost::zbuffer_detail {

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
  // Keys of the whole polygon, not of each piece: the polygon offset of f32 depends on the primitive's greatest depth.
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
  // Clipping makes at most seven pieces of a triangle. Pieces do not overlap, so each is in one and a half tiles on
  // average.
  return std::clamp<std::size_t>(kMostItems / (Tile::count(view) * MeshRange::most_triangles), 1, kMost);
}

}  // namespace frontmost::zbuffer_detail
