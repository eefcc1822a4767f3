// SPDX-License-Identifier: Apache-2.0
// Which large triangles are drawn in which tiles, in rounds that keep the lists within a bound.
//
// Sorting is by nearness and then by corners, so that triangles with the same corners follow each other and all but the
// lowest id go. The order never decides what is seen; without it a tile would draw what it overdraws later.

#include "zbuffer/record_lists.h"

#include <algorithm>
#include <tuple>

namespace frontmost::zbuffer_detail {
namespace {

auto place_of(const TriangleRecord& r) {
  return std::tie(r.x[0], r.y[0], r.x[1], r.y[1], r.x[2], r.y[2], r.key[0], r.key[1], r.key[2]);
}

/// The nearer one; of those at one place, which come one after the other, the lower id.
bool comes_before(const TriangleRecord& a, const TriangleRecord& b) {
  if (a.nearest() != b.nearest()) return a.nearest() > b.nearest();
  return std::tuple_cat(place_of(a), std::tie(a.id)) < std::tuple_cat(place_of(b), std::tie(b.id));
}

bool is_at_one_place(const TriangleRecord& a, const TriangleRecord& b) { return place_of(a) == place_of(b); }

}  // namespace

void RecordLists::plan(const View& view, const Cutouts* cutouts, std::size_t most_items) {
  const auto is_solid = [&](const TriangleRecord& r) { return !cutouts || !cutouts->has(r.id); };
  auto first_cutout = std::partition(records.begin(), records.end(), is_solid);
  // Any order gives the same picture. Nearest first, a tile may stop at the first record that all of its blocks hide.
  std::sort(records.begin(), first_cutout, comes_before);
  std::sort(first_cutout, records.end(), comes_before);
  // A triangle that is there again is hidden by the lower id everywhere, unless that has holes. A few bytes of glTF
  // make a million of one.
  first_cutout = records.erase(std::unique(records.begin(), first_cutout, is_at_one_place), first_cutout);
  first_cutout_ = std::size_t(first_cutout - records.begin());
  split_into_rounds(view, most_items);
}

void RecordLists::list(const TileRange& round, const View& view) {
  lists_.make(round, records.size(),
              [&](std::size_t i, const auto& add) { visit_tiles(records[i], view, round, add); });
}

/// Consecutive tiles whose lists together hold at most `most_items`, one tile at least.
void RecordLists::split_into_rounds(const View& view, std::size_t most_items) {
  const TileRange all{0, Tile::count(view)};
  rounds_.assign(1, all);
  // Even if every record were in every tile: no need to count.
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
