// SPDX-License-Identifier: Apache-2.0
// Coincident lines are drawn once: segments are added by rank, each without the stretches that earlier ones cover.
//
//    there already       ======      =====
//    the new line    ----------------------------
//    what is added   ----      ------     ------        its stretches that nothing covers yet
//
// Within a rank the first line stays whole.
#include <algorithm>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/work_limit.h"
#include "lines/strokes/laid_lines.h"

namespace frontmost::lines_detail {
namespace {

class OverlapRemover {
 public:
  /// Accepts pieces of `lines`. Precondition: there are lines.
  OverlapRemover(const std::vector<Line>& lines, double apart) : near_(apart), index_(lines, near_) {}

  /// Appends the uncovered stretches of `line` to `fresh`. \returns how many lines were compared with it.
  std::size_t lay(const Line& line, std::vector<LineSegment>& fresh) {
    covered_.clear();
    ++asking_;
    const std::size_t compared = index_.for_each(line, [&](std::span<const std::uint32_t> numbers) {
      for (const std::uint32_t other : numbers) {
        if (asked_[other] == asking_) continue;
        asked_[other] = asking_;
        const Stretch there = near_.overlap(line, laid_[other]);
        if (there.end > there.begin) covered_.push_back(there);
      }
    });
    if (covered_.empty()) {
      add(line, fresh);
      return compared;
    }
    std::sort(covered_.begin(), covered_.end(), [](const Stretch& a, const Stretch& b) { return a.begin < b.begin; });
    covered_.push_back({line.length, line.length});
    const double least = std::max(Nearness::shortest, near_.apart());
    double at = 0;
    for (const Stretch& c : covered_) {
      if (c.begin - at > least) {
        // The line's own ends are kept to the bit, so that neighbouring lines still meet them.
        const glm::dvec2 from = at == 0 ? line.from : line.from + line.along * at;
        const glm::dvec2 to = c.begin == line.length ? line.to : line.from + line.along * c.begin;
        add(Line({from, to, line.rank, line.is_contour}), fresh);
      }
      at = std::max(at, c.end);
    }
    return compared;
  }

 private:
  void add(const Line& line, std::vector<LineSegment>& fresh) {
    fresh.push_back(line);
    index_.add(std::uint32_t(laid_.size()), line);
    laid_.push_back(line);
    asked_.push_back(0);
  }

  const Nearness near_;
  LaidLines index_;
  std::vector<Line> laid_;
  std::vector<std::uint32_t> asked_;  ///< by line: the last query that found it
  std::uint32_t asking_ = 0;
  std::vector<Stretch> covered_;  ///< covered stretches of the current line
};

}  // namespace

LaidLines::Extent::Extent(const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    low = glm::min(low, glm::min(line.from, line.to));
    high = glm::max(high, glm::max(line.from, line.to));
    if (line.is_long()) continue;
    short_length += line.length;
    ++short_count;
  }
}

/// A grid with about one short line to a cell. The least size of a cell matters for a drawing of one point.
SquareGrid LaidLines::Extent::grid(double near) const {
  const double count = std::max(short_count, 1.0), side = std::max({high.x - low.x, high.y - low.y, 1e-6});
  const double cell = std::max({short_length / count, side / std::sqrt(count), side / 4096, 8 * near});
  const glm::ivec2 cells = glm::ivec2((high - low + 2 * near) / cell) + 1;
  return {low - near, cell, cells.x, cells.y};
}

LaidLines::LaidLines(const std::vector<Line>& lines, const Nearness& nearness)
    : near_(nearness),
      extent_(lines),
      cells_(extent_.grid(near_.apart())),
      lines_(cells_.count()),
      long_(extent_.low, extent_.high, nearness) {}

std::vector<LineSegment> draw_once(const std::vector<LineSegment>& segments, double apart, const Execution& execution) {
  std::vector<std::uint32_t> order(segments.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return segments[a].rank < segments[b].rank; });
  std::vector<Line> lines;
  lines.reserve(segments.size());
  for (const std::uint32_t i : order)
    if (glm::distance(segments[i].from, segments[i].to) > Nearness::shortest / 4) lines.emplace_back(segments[i]);
  std::vector<LineSegment> fresh;
  if (lines.empty()) return fresh;
  fresh.reserve(lines.size());
  OverlapRemover overlaps(lines, apart);
  constexpr std::uint64_t most = std::uint64_t(1) << 33;  // half a minute
  WorkLimit limit(execution, most, "strokes");
  std::uint64_t compared = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i % 256 == 0)
      limit.add(std::exchange(compared, 0), [&] {
        return "more than " + std::to_string(most) + " comparisons of " + std::to_string(lines.size()) +
               " lines, of which most lie within some pixels of each other; draw the model larger, or leave some out";
      });
    if (i % 4096 == 0) report_progress(execution, "strokes", 0.1 + 0.4 * double(i) / double(lines.size()));
    compared += overlaps.lay(lines[i], fresh);
  }
  return fresh;
}

}  // namespace frontmost::lines_detail
