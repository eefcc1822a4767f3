// SPDX-License-Identifier: Apache-2.0
// An index of the lines that are drawn so far. Short lines are stored in the cells of a grid that they pass. Long lines
// would pass too many cells and are stored by the infinite lines on which they lie.
//
//    short lines    cells that they pass               a cell holds a few lines, and each is tested
//    long lines     a plane of heights (long_lines.h)  a line crosses hundreds of others, and lies on one or two
#pragma once

#include <span>
#include <vector>

#include "lines/square_grid.h"
#include "lines/strokes/long_lines.h"

namespace frontmost::lines_detail {

class LaidLines {
 public:
  /// For pieces of `lines`. Precondition: not empty.
  LaidLines(const std::vector<Line>& lines, const Nearness& nearness) : LaidLines(Extent(lines), nearness) {}

  void add(std::uint32_t number, const Line& line) {
    if (line.is_long()) return long_.add(number, line);
    cells_.visit_along(line.from, line.to, reach_of(line), [&](const PassedCell& passed) {
      lines_[passed.cell].emplace_back(line, number);
      return true;
    });
  }

  /// Calls visit(numbers) for candidates among the added lines, possibly repeatedly. These contain all short lines with
  /// a stretch by Nearness::overlap(), and of long ones those that LongLines::for_each() finds. \returns how many were
  /// tested.
  ///
  /// Cost: a few tests per line in drawings. Where thousands of lines are in one cell, as the details of a model that
  /// is seen very small, each is tested against each: 20 thousand take up to 1.4 s, four times as many sixteen times as
  /// long.
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
  /// The bounding box of the lines, and the number and total length of the short ones.
  struct Extent {
    explicit Extent(const std::vector<Line>& lines);
    glm::dvec2 low{1e300}, high{-1e300};
    double short_length = 0, short_count = 0;
  };
  LaidLines(const Extent& extent, const Nearness& nearness);

  /// The greatest distance from a line of lines that lie on it, with some room.
  [[nodiscard]] double reach_of(const Line& line) const { return near_.reach_of(line.length + Nearness::shortest); }

  const Nearness near_;
  SquareGrid cells_;
  std::vector<std::vector<BriefLine>> lines_;  ///< the short lines by cell
  LongLines long_;
};

}  // namespace frontmost::lines_detail
