// SPDX-License-Identifier: Apache-2.0
// Division of a crowded cell of an occluder grid.
//
//        +----+----+----+----+     A cell is divided into 4 x 4 parts, and these again as long as that pays. A triangle
//        |....|    |    |    |     is listed in the parts that it touches. If it covers a part wholly, triangles beyond
//        |....|----+----+----|     it there, by distance or by plane, hide nothing more and are left out of the part.
//        |    |    |    |    |     So a crowd of sheets behind one sheet takes one entry.
//        +----+----+----+----+
#include <array>
#include <limits>

#include "lines/hiding/grid_plan.h"

namespace frontmost::lines_detail {
namespace {

/// The smallest part is 2^-14 of a cell: still very much larger than kCellPad.
constexpr double kLeastSize = 1.0 / (1 << 12);
constexpr std::size_t kEntriesPerPoll = 1 << 13, kEntriesPerLook = 64;

/// The nearest triangle that covers a part whole: an entry of the cell.
struct NearestCover {
  float farthest = std::numeric_limits<float>::infinity();
  std::size_t entry = 0;
};

/// Removes triangles beyond the part's cover, by distance or by plane. `numbers` gives the place of each entry of the
/// part among the cell's entries, and so in `depths`.
void leave_beyond(const GridPlan& plan, const std::vector<CellDepth>& depths, const std::vector<std::size_t>& numbers,
                  const NearestCover& cover, CrowdedCell<CellEntry>& part) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const CellEntry& entry = part.items[i];
    if (entry.nearest > cover.farthest) continue;
    const bool is_near = plan.is_near(plan.footprints[entry.footprint]);
    if (!is_near && depths[numbers[i]].is_beyond(depths[cover.entry], part.square)) continue;
    part.items[kept++] = entry;
  }
  part.items.resize(kept);
}

CellParts<CellEntry> split_entries(const GridPlan& plan, const CrowdedCell<CellEntry>& whole) {
  check_cancelled(plan.execution);
  const SquareGrid grid = CellTree::parts_of(whole.square);
  CellParts<CellEntry> parts;
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i].square = grid.square(i);
  std::vector<CellDepth> depths;
  std::array<std::vector<std::size_t>, CellTree::parts> numbers;
  std::array<NearestCover, CellTree::parts> covers;
  for (std::size_t e = 0; e < whole.items.size(); ++e) {
    if (e % kEntriesPerPoll == 0) check_cancelled(plan.execution);
    // All entries that follow are beyond the cover of each part.
    const auto is_beyond = [&](const NearestCover& cover) { return whole.items[e].nearest > cover.farthest; };
    if (e % kEntriesPerLook == 0 && std::all_of(covers.begin(), covers.end(), is_beyond)) break;
    const Footprint& footprint = plan.footprints[whole.items[e].footprint];
    const bool is_near = plan.is_near(footprint);
    depths.push_back(plan.depth_of(footprint.triangle));
    const CellDepth& depth = depths.back();
    grid.visit_box(footprint.low, footprint.high, kCellPad, [&](int x, int y) {
      const std::size_t i = grid.number(x, y);
      CrowdedCell<CellEntry>& part = parts[i];
      NearestCover& cover = covers[i];
      if (!is_near && depth.is_beside(part.square)) return;
      const float nearest =
          is_near ? footprint.nearest : std::max(footprint.nearest, rounded_down(depth.nearest(part.square)));
      if (nearest > cover.farthest) return;
      numbers[i].push_back(e);
      part.items.push_back({nearest, whole.items[e].footprint});
      if (plan.keeps_all || is_near || !depth.covers(part.square)) return;
      const float farthest = rounded_up(depth.farthest(part.square));
      if (farthest < cover.farthest) cover = {farthest, e};
    });
  }
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (covers[i].farthest < std::numeric_limits<float>::infinity())
      leave_beyond(plan, depths, numbers[i], covers[i], parts[i]);
  for (CrowdedCell<CellEntry>& part : parts) std::sort(part.items.begin(), part.items.end());
  return parts;
}

}  // namespace

DividedCell<CellEntry> divide_entries(const GridPlan& plan, CrowdedCell<CellEntry> cell) {
  return divide_cell(std::move(cell), {64, kLeastSize},
                     [&](const CrowdedCell<CellEntry>& whole) { return split_entries(plan, whole); });
}

}  // namespace frontmost::lines_detail
