// SPDX-License-Identifier: Apache-2.0
// The lines that are drawn so far, found by where they lie: short ones in the cells of a grid that they pass, long
// ones, which would pass too many, by the lines that they lie on.
//
//    short lines    cells that they pass               a cell holds a few lines, and each is looked at
//    long lines     a plane of heights (long_lines.h)  a line crosses hundreds of others, and lies on one or two
#pragma once

#include <span>
#include <vector>

#include "lines/crowded_cells.h"
#include "lines/strokes/long_lines.h"

namespace frontmost::lines_detail {

class LaidLines {
 public:
  /// For lines that are pieces of these. Precondition: not empty.
  LaidLines(const std::vector<Line>& lines, const Nearness& nearness) : LaidLines(lines, nearness, Extent(lines)) {}

  void add(std::uint32_t number, const Line& line) {
    if (line.is_long()) return long_.add(number, line);
    cells_.visit_along(line.from, line.to, reach_of(line), [&](const PassedCell& passed) {
      lines_[passed.cell].emplace_back(line, number);
      return true;
    });
  }

  /// Calls visit(numbers) for some of those that were added, perhaps again and again: all that have a stretch by
  /// Nearness::overlap() are among them, of long ones those that LongLines::for_each() tells of. \returns how many were
  /// looked at.
  ///
  /// Cost: a few lines each in drawings. Where thousands begin in one pixel, or run through one all along, each of them
  /// is looked at for each other: 20 thousand take 1.4 s, and four times as many sixteen times as long.
  template <class Visit>
  std::size_t for_each(const Line& line, const Visit& visit) const {
    const SoughtLine sought(line, near_);
    std::size_t looked_at = 0;
    cells_.visit_along(line.from, line.to, reach_of(line), [&](const PassedCell& passed) {
      looked_at += lines_[passed.cell].size();
      visit_likely(lines_[passed.cell], sought, visit);
      return true;
    });
    return long_.is_empty() ? looked_at : looked_at + long_.for_each(line, sought, visit);
  }

 private:
  /// What lines take up, and how many are short.
  struct Extent {
    explicit Extent(const std::vector<Line>& lines);
    glm::dvec2 low{1e300}, high{-1e300};
    double short_length = 0, short_count = 0;
  };
  LaidLines(const std::vector<Line>& lines, const Nearness& nearness, const Extent& extent);
  void divide_crowds(const std::vector<Line>& lines);

  /// How far from a line what lies on it may be, and a little.
  [[nodiscard]] double reach_of(const Line& line) const { return near_.reach_of(line.length + Nearness::shortest); }

  const Nearness near_;
  CellTree cells_;
  std::vector<std::vector<BriefLine>> lines_;  ///< by cell: the short ones
  LongLines long_;
};

}  // namespace frontmost::lines_detail
