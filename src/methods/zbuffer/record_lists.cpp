// SPDX-License-Identifier: Apache-2.0
// Which large triangles are drawn in which tiles, in rounds that keep the lists within a bound.
//
// Records are sorted by nearness and then by vertices, so triangles with the same vertices follow each other and all
// but the lowest id are dropped. The order never decides what is seen; it only saves overdraw.

#include "zbuffer/record_lists.h"

#include <algorithm>
#include <tuple>

namespace frontmost::zbuffer_detail {
namespace {

auto place_of(const TriangleRecord& r) {
  return std::tie(r.x[0], r.y[0], r.x[1], r.y[1], r.x[2], r.y[2], r.key[0], r.key[1], r.key[2]);
}

/// True if `a` is nearer. Records with the same vertices follow each other, the lower id first.
bool comes_before(const TriangleRecord& a, const TriangleRecord& b) {
  if (a.nearest() != b.nearest()) return a.nearest() > b.nearest();
  return std::tuple_cat(place_of(a), std::tie(a.id)) < std::tuple_cat(place_of(b), std::tie(b.id));
}

bool is_at_one_place(const TriangleRecord& a, const TriangleRecord& b) { return place_of(a) == place_of(b); }

}  // namespace

void RecordLists::plan(const View& view, const Cutouts* cutouts, std::size_t most_items) {
  const auto is_solid = [&](const TriangleRecord& r) { return !cutouts || !cutouts->has(r.id); };
  auto first_cutout = std::partition(records.begin(), records.end(), is_solid);
  // Any order gives the same picture. With the nearest first, a tile may stop at the first record that all its blocks
  // hide.
  std::sort(records.begin(), first_cutout, comes_before);
  std::sort(first_cutout, records.end(), comes_before);
  // The lower id hides a copy of itself everywhere, unless it has holes. A few bytes of glTF make a million copies of
  // one triangle.
  first_cutout = records.erase(std::unique(records.begin(), first_cutout, is_at_one_place), first_cutout);
  first_cutout_ = std::size_t(first_cutout - records.begin());
  split_into_rounds(view, most_items);
}

void RecordLists::list(const TileRange& round, const View& view) {
  lists_.make(round, records.size(),
              [&](std::size_t i, const auto& add) { visit_tiles(records[i], view, round, add); });
}

/// Splits the tiles into rounds whose lists hold at most `most_items` together, or a single tile.
void RecordLists::split_into_rounds(const View& view, std::size_t most_items) {
  const TileRange all{0, Tile::count(view)};
  rounds_.assign(1, all);
  // The bound holds even if every record is in every tile: counting is not needed.
  if (records.size() <= most_items / all.end) return;
  std::vector<std::uint32_t> counts(all.end, 0);
  for (const TriangleRecord& record : records)
    visit_tiles(record, view, all, [&](std::size_t tile) { ++counts[tile]; });
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

}  // namespace frontmost::zbuffer_detail
