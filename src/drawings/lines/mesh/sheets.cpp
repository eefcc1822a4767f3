// SPDX-License-Identifier: Apache-2.0
// Sides with the same third vertex are copies. Two groups of copies form a sheet. Three or more groups form sheets only
// if one group is as large as all others together: it is the part that the others share, like the wall between two
// rooms.
//
//        A       B            three sides at an edge (o), S twice: the sheets are A-S and B-S
//         \     /
//          \   /              sheets without a common side must at least lie on each other; else surfaces
//           \ /               meet at the edge, and it is drawn
//            o
//            |  S (twice)
#include "lines/mesh/sheets.h"

#include <algorithm>

#include "geometry/disjoint_sets.h"

namespace frontmost::lines_detail {
namespace {

struct OwnedSide {
  Side side;
  SurfaceOf surface;
};

/// Sides with the same opposite vertex.
using SidesOfCopy = std::span<const OwnedSide>;

/// Groups of copies. Precondition: `sides` are sorted by opposite vertex.
std::vector<SidesOfCopy> copies_of(std::span<const OwnedSide> sides) {
  std::vector<SidesOfCopy> all;
  for (auto begin = sides.begin(); begin != sides.end();) {
    const auto end =
        std::find_if(begin, sides.end(), [&](const OwnedSide& s) { return s.side.opposite != begin->side.opposite; });
    all.emplace_back(begin, end);
    begin = end;
  }
  return all;
}

/// One side of each group: of the same object and material if possible, else the first ones.
SidesOfSheet sheet_of(const SidesOfCopy& a, const SidesOfCopy& b) {
  for (const OwnedSide& one : a)
    for (const OwnedSide& other : b)
      if (one.surface == other.surface) return {one.side, other.side};
  return {a[0].side, b[0].side};
}

/// Appends sheets that pair all sides. \returns false, and appends none, where that is impossible.
bool pair_up(std::span<const OwnedSide> sides, std::vector<SidesOfSheet>& sheets) {
  const std::vector<SidesOfCopy> copies = copies_of(sides);
  if (copies.size() < 2) return false;
  // With two groups, their sizes do not matter.
  const auto centre = std::find_if(copies.begin(), copies.end(), [&](const SidesOfCopy& c) {
    return copies.size() == 2 || 2 * c.size() == sides.size();
  });
  if (centre == copies.end()) return false;
  for (auto other = copies.begin(); other != copies.end(); ++other)
    if (other != centre) sheets.push_back(sheet_of(*centre, *other));
  return true;
}

/// Whether all sheets are connected by sides that they share or that lie on each other.
bool is_connected(const std::vector<SidesOfSheet>& sheets, const SheetQuestions& questions) {
  DisjointSets<> groups(sheets.size());
  std::size_t count = sheets.size();
  const auto join = [&](std::size_t a, std::size_t b) { count -= groups.join(std::uint32_t(a), std::uint32_t(b)); };
  std::vector<std::pair<std::uint32_t, std::size_t>> ends;  // opposite vertex, sheet
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    ends.emplace_back(sheets[i].first.opposite, i);
    ends.emplace_back(sheets[i].second.opposite, i);
  }
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 1; i < ends.size(); ++i)
    if (ends[i].first == ends[i - 1].first) join(ends[i].second, ends[i - 1].second);
  for (std::size_t i = 1; i < sheets.size() && count > 1; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (groups.leader_of(std::uint32_t(i)) == groups.leader_of(std::uint32_t(j))) continue;
      const auto& [a, b] = sheets[i];
      const auto& [c, d] = sheets[j];
      if (questions.overlap(a, c) || questions.overlap(a, d) || questions.overlap(b, c) || questions.overlap(b, d))
        join(i, j);
    }
  return count == 1;
}

}  // namespace

std::optional<std::vector<SidesOfSheet>> find_sheets(std::span<const Side> sides, const SheetQuestions& questions) {
  std::vector<OwnedSide> owned;
  owned.reserve(sides.size());
  for (const Side& side : sides) owned.push_back({side, questions.surface_of(side.triangle)});
  // The stable sort keeps sides of one object with the same opposite vertex together, also in `left`.
  std::stable_sort(owned.begin(), owned.end(),
                   [](const OwnedSide& a, const OwnedSide& b) { return a.surface.instance < b.surface.instance; });
  std::vector<SidesOfSheet> sheets;
  std::vector<OwnedSide> left;
  for (auto begin = owned.begin(); begin != owned.end();) {
    const auto end = std::find_if(begin, owned.end(),
                                  [&](const OwnedSide& s) { return s.surface.instance != begin->surface.instance; });
    if (!pair_up({&*begin, std::size_t(end - begin)}, sheets)) left.insert(left.end(), begin, end);
    begin = end;
  }
  std::stable_sort(left.begin(), left.end(),
                   [](const OwnedSide& a, const OwnedSide& b) { return a.side.opposite < b.side.opposite; });
  if (!left.empty() && !pair_up(left, sheets)) return std::nullopt;
  if (!is_connected(sheets, questions)) return std::nullopt;
  return sheets;
}

}  // namespace frontmost::lines_detail
