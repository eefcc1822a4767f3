// SPDX-License-Identifier: Apache-2.0
// Triangles on the screen that are set up one by one: large triangles, and triangles that had to be clipped.
//
// Edge values are exact: coordinates have 22 bits, so products have 46 bits and fit 64-bit integers. Within a tile,
// edge values are shifted and limited to 32 bits such that every sign stays right.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "base/pool.h"
#include "surfaces/cluster_set.h"
#include "view/clip.h"
#include "view/facing_rule.h"
#include "view/screen_transform.h"
#include "view/triangle_keys.h"
#include "zbuffer/tile/tile.h"

namespace frontmost::zbuffer_detail {

/// A triangle on the screen. Vertices are in 1/256 pixel, relative to an origin that the caller chooses. After
/// orient(), the order of vertices makes the area positive (clockwise to the eye, because y is down).
struct TriangleRecord {
  std::int32_t x[3], y[3];
  float key[3];
  PrimitiveId id;

  [[nodiscard]] float nearest() const { return std::max({key[0], key[1], key[2]}); }
};

/// Edge functions at a tile's first sample, shifted right by 8, and their steps from pixel to pixel. A sample is
/// covered if none of the three is negative. Left and top edges include their points.
struct TriangleEdges {
  // Across 127 pixels in x and 127 in y, an edge value changes by at most 2 * 127 * 2^22 < 2^30. So a first value that
  // is limited to `limit` gives the right sign at every sample, and all values fit 32 bits.
  static constexpr std::int64_t limit = std::int64_t(1) << 30;

  std::int32_t first[3], step_x[3], step_y[3];

  /// Precondition: `sample` lies in the tile's first pixel, vertices are relative to the tile, and the area is
  /// positive.
  TriangleEdges(const TriangleRecord& r, const glm::ivec2& sample) {
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      const std::int32_t dx = r.x[n] - r.x[k], dy = r.y[n] - r.y[k];
      const bool is_top_left = dy < 0 || (dy == 0 && dx > 0);
      const std::int64_t e =
          std::int64_t(dx) * (sample.y - r.y[k]) - std::int64_t(dy) * (sample.x - r.x[k]) - (is_top_left ? 0 : 1);
      first[k] = std::int32_t(std::clamp(e >> 8, -limit, limit));
      step_x[k] = -dy;
      step_y[k] = dx;
    }
  }
};

/// The view that triangles are placed in, and the rules for placing them.
struct PlaceTarget {
  const ScreenTransform& transform;
  const View& view;
  FacingRule facing;
  glm::ivec2 low, high;  ///< least and greatest sample offset
  Isa isa;

  /// Borrows everything. `sides` belongs to the scene that is placed.
  PlaceTarget(const ScreenTransform& t, const View& v, const MaterialSides* sides, Isa i);
};

/// Makes a record's area positive. \returns false if the record is culled, or has no area and so covers nothing.
[[nodiscard]] bool orient(TriangleRecord& record, const FacingRule& facing);

/// Appends the triangles of one cluster that may be seen, clipped where needed. Their vertices are relative to the
/// image's top left.
void append_records(const PlaceTarget& target, const ClusterSet& set, const Cluster& cluster,
                    std::vector<TriangleRecord>& records);

/// Appends the triangles of one clipped polygon that may be seen.
void append_polygon(const PlaceTarget& target, const ClippedPolygon& polygon, PrimitiveId id,
                    std::vector<TriangleRecord>& records);

/// The pixels within the image whose samples a record may cover. Empty (x1 < x0 or y1 < y0) if there are none.
[[nodiscard]] PixelRect pixel_rect(const TriangleRecord& record, int width, int height);

/// The pixels that have a sample inside the triangle's bounding box. `low` and `high` are the least and greatest sample
/// offsets. Most triangles smaller than a pixel have no such pixel, and cover nothing.
[[nodiscard]] PixelRect sampled_rect(const TriangleRecord& record, const glm::ivec2& low, const glm::ivec2& high,
                                     int width, int height);

/// Calls visit(record) for the triangles of a clipped polygon, which are not oriented yet. Their vertices are relative
/// to the image's top left.
/// The triangles form a fan; the top-left rule gives each sample on an inner edge to one triangle.
template <class Visit>
void for_each_of_fan(const ClippedPolygon& polygon, const ScreenTransform& t, PrimitiveId id, const Visit& visit) {
  for (std::size_t k = 2; k < std::size_t(polygon.count); ++k) {
    const ScreenVertex* const fan[3] = {&polygon.corners[0], &polygon.corners[k - 1], &polygon.corners[k]};
    TriangleRecord record;
    record.id = id;
    for (int v = 0; v < 3; ++v) {
      record.x[v] = fan[v]->x + t.centre_x;
      record.y[v] = fan[v]->y + t.centre_y;
      record.key[v] = fan[v]->key;
    }
    visit(record);
  }
}

/// True if the rectangle's corners show that all samples of its pixels lie outside one edge. This test is quick.
[[nodiscard]] bool misses(const TriangleRecord& record, const PixelRect& rect);

/// Calls visit(x, y) for the pixels of `rect` whose sample, `offset` from the pixel's corner, is covered.
template <class Visit>
void visit_covered(const TriangleRecord& r, const PixelRect& rect, const glm::ivec2& offset, const Visit& visit) {
  // Edge values are exact in 64 bits: coordinates within the guard band have 22 bits, differences 23 bits, and sums of
  // two products 47 bits.
  std::int64_t row[3], step_x[3], step_y[3];
  for (int k = 0; k < 3; ++k) {
    const int n = k == 2 ? 0 : k + 1;
    const std::int64_t dx = r.x[n] - r.x[k], dy = r.y[n] - r.y[k];
    const bool is_top_left = dy < 0 || (dy == 0 && dx > 0);
    row[k] = dx * (rect.y0 * kSubPixels + offset.y - r.y[k]) - dy * (rect.x0 * kSubPixels + offset.x - r.x[k]) -
             (is_top_left ? 0 : 1);
    step_x[k] = -dy * kSubPixels;
    step_y[k] = dx * kSubPixels;
  }
  for (int y = rect.y0; y <= rect.y1; ++y) {
    std::int64_t e[3] = {row[0], row[1], row[2]};
    for (int x = rect.x0; x <= rect.x1; ++x) {
      if ((e[0] | e[1] | e[2]) >= 0) visit(x, y);
      for (int k = 0; k < 3; ++k) e[k] += step_x[k];
    }
    for (int k = 0; k < 3; ++k) row[k] += step_y[k];
  }
}

/// The most items that the lists of one round hold (256 MiB), unless a single tile has more.
inline constexpr std::size_t kMostRecordItems = std::size_t(1) << 26;

/// The records of a frame, nearest first, and for each tile the list of records that may be seen in it. Planning the
/// next frame reuses the memory. A large triangle is in the lists of many tiles, so the lists together could outgrow
/// the memory. Lists are therefore made round by round:
///
///    round 0    tiles 0 ... 40      lists of at most 2^26 items together
///    round 1    tiles 41 ... 90     made when round 0 is drawn, in the same memory
class RecordLists {
 public:
  /// The caller fills `records` before plan(). Vertices are relative to the image's top left.
  std::vector<TriangleRecord> records;

  /// Sorts the records nearest first, cutouts after all others, and finds the rounds. Among solid records with the same
  /// vertices plan() keeps only the one with the lowest id.
  void plan(const View& view, const Cutouts* cutouts, std::size_t most_items = kMostRecordItems);
  /// The rounds in which tiles are drawn. An ordinary scene needs one round. A million triangles that each fill the
  /// largest image need many, because they make 16 thousand million pairs of record and tile.
  [[nodiscard]] std::span<const TileRange> rounds() const { return rounds_; }
  /// Lists the records that may be seen in each tile of a round, and drops the lists of the round before.
  void list(const TileRange& round, const View& view);
  /// Precondition: `tile` belongs to the round listed last.
  [[nodiscard]] PartedList of(std::size_t tile) const {
    return {lists_.of(tile), [&](std::uint32_t i) { return i >= first_cutout_; }};
  }

 private:
  void split_into_rounds(const View& view, std::size_t most_items);

  std::size_t first_cutout_ = 0;
  TileLists lists_;
  std::vector<TileRange> rounds_;
};

/// Calls draw(tile, scratch) for every tile, after the tile's records are listed. Several threads draw tiles at once,
/// each with its own scratch.
template <class Draw>
void draw_tiles(RecordLists& records, const View& view, const Execution& execution, Pool<TileScratch>& scratches,
                const Draw& draw) {
  for (const TileRange& round : records.rounds()) {
    records.list(round, view);
    parallel_for(execution, round.end - round.begin, 1, [&](std::size_t begin, std::size_t end) {
      const auto scratch = scratches.borrow([] { return std::make_unique<TileScratch>(); });
      scratch->reserve(std::size_t(view.samples));
      for (std::size_t tile = round.begin + begin; tile < round.begin + end; ++tile) draw(tile, *scratch);
    });
  }
}

/// Calls add(tile) for the tiles of `range` in which a record may be seen. Vertices are relative to the image's top
/// left.
template <class Add>
void visit_tiles(const TriangleRecord& record, const View& view, const TileRange& range, const Add& add) {
  const PixelRect rect = pixel_rect(record, view.width, view.height);
  if (rect.is_empty()) return;
  const TileRect tiles(rect);
  const std::size_t across = Tile::tiles_across(view);
  const int first_row = int(range.begin / across), last_row = int((range.end - 1) / across);
  for (int y = std::max(tiles.y0, first_row); y <= std::min(tiles.y1, last_row); ++y)
    for (int x = tiles.x0; x <= tiles.x1; ++x) {
      const std::size_t tile = std::size_t(y) * across + std::size_t(x);
      if (tile < range.begin || tile >= range.end) continue;
      const PixelRect pixels{x * kTileSize, y * kTileSize, (x + 1) * kTileSize - 1, (y + 1) * kTileSize - 1};
      // A long diagonal triangle touches few tiles of its rectangle, so misses() tests each tile. A rectangle within
      // one tile needs no such test.
      if (tiles.count() == 1 || !misses(record, pixels)) add(tile);
    }
}

}  // namespace frontmost::zbuffer_detail
