// SPDX-License-Identifier: Apache-2.0
// Lines that lie on each other are drawn once.
//
// Segments are laid down by rank, each without what lies there already. What could lie there is found in the cells of a
// grid: about one segment to the cell, and where more come together, as in a detailed part of a large scene, the cell
// becomes a grid itself. Long segments would pass too many cells, and are found by the lines they lie on.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/parallel.h"
#include "lines/strokes/long_lines.h"
#include "lines/strokes/near_lines.h"

namespace frontmost::lines_detail {
namespace {

/// Square cells; crowded ones are divided again.
class Grid {
 public:
  struct Cell {
    NearLines lines;
    std::unique_ptr<Grid> finer;  ///< has them instead
  };

  Grid(const glm::dvec2& low, double cell, const glm::ivec2& count, const Nearness& near)
      : near_(near), low_(low), cell_(cell), count_(count), cells_(std::size_t(count.x) * std::size_t(count.y)) {}

  /// Calls visit(numbers) as NearLines do, in all cells that the line passes with what counts as near to spare.
  template <class Visit>
  void for_each(const Line& line, const SoughtLine& sought, const Visit& visit) const {
    for_each_cell(line, [&](std::size_t number, const glm::ivec2&) {
      const Cell& cell = cells_[number];
      cell.finer ? cell.finer->for_each(line, sought, visit) : cell.lines.for_each(sought, visit);
    });
  }

  /// Adds the last of the lines `laid`. \returns how many entries of cells are new.
  std::size_t add(const std::vector<Line>& laid, bool may_divide) {
    const auto number = std::uint32_t(laid.size() - 1);
    std::size_t entries = 0;
    for_each_cell(laid[number], [&](std::size_t i, const glm::ivec2& at) {
      Cell& cell = cells_[i];
      if (!cell.finer && may_divide && cell.lines.is_full() && cell_ > finest() * divisions)
        entries += divide(cell, at, laid);
      if (cell.finer) {
        entries += cell.finer->add(laid, may_divide);
      } else {
        cell.lines.add(number, laid, near_);
        ++entries;
      }
    });
    return entries;
  }

 private:
  static constexpr int divisions = 8;

  /// Most in a crowd is short, and lies on little: cells may be less than what counts as near for long ones.
  [[nodiscard]] double finest() const { return std::max(2 * Nearness::shortest, near_.apart() / 16); }
  /// How far from a segment what lies on it may be, and a little.
  [[nodiscard]] double reach_of(const Line& s) const { return near_.reach_of(s.length + Nearness::shortest); }

  std::size_t divide(Cell& cell, const glm::ivec2& at, const std::vector<Line>& laid) {
    std::size_t entries = 0;
    cell.finer = std::make_unique<Grid>(low_ + glm::dvec2(at) * cell_, cell_ / divisions, glm::ivec2(divisions), near_);
    for (const std::uint32_t number : cell.lines.numbers())
      cell.finer->for_each_cell(laid[number], [&](std::size_t i, const glm::ivec2&) {
        cell.finer->cells_[i].lines.add(number, laid, near_);
        ++entries;
      });
    cell.lines = {};
    return entries;
  }

  [[nodiscard]] int column(double x) const { return std::clamp(int((x - low_.x) / cell_), 0, count_.x - 1); }
  [[nodiscard]] int row(double y) const { return std::clamp(int((y - low_.y) / cell_), 0, count_.y - 1); }

  /// Column by column, the rows that the segment passes there.
  template <class Visit>
  void for_each_cell(const Line& s, const Visit& visit) const {
    const double near = reach_of(s);
    const glm::dvec2 a = s.from.x <= s.to.x ? s.from : s.to, b = s.from.x <= s.to.x ? s.to : s.from;
    const double width = b.x - a.x;
    for (int x = column(a.x - near); x <= column(b.x + near); ++x) {
      double y0 = a.y, y1 = b.y;
      if (width > 2 * near) {
        const double left = low_.x + x * cell_ - near, right = left + cell_ + 2 * near;
        y0 = a.y + (b.y - a.y) * std::clamp((left - a.x) / width, 0.0, 1.0);
        y1 = a.y + (b.y - a.y) * std::clamp((right - a.x) / width, 0.0, 1.0);
      }
      if (y0 > y1) std::swap(y0, y1);
      // A divided cell has the segment whole: what of it passes above or below is not in its border cells.
      if (y1 + near < low_.y || y0 - near > low_.y + count_.y * cell_) continue;
      for (int y = row(y0 - near); y <= row(y1 + near); ++y)
        visit(std::size_t(y) * std::size_t(count_.x) + std::size_t(x), glm::ivec2(x, y));
    }
  }

  const Nearness near_;
  const glm::dvec2 low_;
  const double cell_;
  const glm::ivec2 count_;
  std::vector<Cell> cells_;
};

/// What lines take up, and how many are short.
struct Extent {
  explicit Extent(const std::vector<Segment>& segments) {
    for (const Segment& s : segments) {
      low = glm::min(low, glm::min(s.from, s.to));
      high = glm::max(high, glm::max(s.from, s.to));
      const double length = glm::distance(s.from, s.to);
      if (length > Line::long_from) continue;
      short_length += length;
      ++short_count;
    }
  }

  /// A grid for the short ones.
  [[nodiscard]] Grid grid(const Nearness& nearness) const {
    const double near = nearness.apart();
    const double count = std::max(short_count, 1.0), side = std::max({high.x - low.x, high.y - low.y, 1e-6});
    // Never finer than what counts as one place: a drawing of one point would have ten million cells a side.
    const double cell = std::max({short_length / count, side / std::sqrt(count), side / 4096, 8 * near});
    return {low - near, cell, glm::ivec2((high - low + 2 * near) / cell) + 1, nearness};
  }

  glm::dvec2 low{1e300}, high{-1e300};
  double short_length = 0, short_count = 0;
};

class Sheet {
 public:
  /// Precondition: not empty.
  Sheet(const Extent& extent, double apart)
      : near_(apart), grid_(extent.grid(near_)), long_(extent.low, extent.high, near_) {}

  /// Adds what of `line` is not there yet to `fresh`.
  void lay(const Line& line, std::vector<Segment>& fresh) {
    covered_.clear();
    ++asking_;
    const SoughtLine sought(line, near_);
    const auto ask = [&](std::span<const std::uint32_t> numbers) { find_covered(line, numbers); };
    grid_.for_each(line, sought, ask);
    if (!long_.is_empty()) long_.for_each(line, sought, ask);
    if (covered_.empty()) return add(line, fresh);
    std::sort(covered_.begin(), covered_.end(), [](const Stretch& a, const Stretch& b) { return a.begin < b.begin; });
    covered_.push_back({line.length, line.length});
    const double least = std::max(Nearness::shortest, near_.apart());
    double at = 0;
    for (const Stretch& c : covered_) {
      if (c.begin - at > least) {
        // The line's own ends to the bit, so that its neighbours find them.
        const glm::dvec2 from = at == 0 ? line.from : line.from + line.along * at;
        const glm::dvec2 to = c.begin == line.length ? line.to : line.from + line.along * c.begin;
        add(Line({from, to, line.rank, line.is_contour}), fresh);
      }
      at = std::max(at, c.end);
    }
  }

 private:
  void find_covered(const Line& line, std::span<const std::uint32_t> numbers) {
    for (const std::uint32_t other : numbers) {
      if (asked_[other] == asking_) continue;
      asked_[other] = asking_;
      const Stretch there = near_.overlap(line, laid_[other]);
      if (there.end > there.begin) covered_.push_back(there);
    }
  }

  void add(const Line& line, std::vector<Segment>& fresh) {
    fresh.push_back(line);
    laid_.push_back(line);
    asked_.push_back(0);
    if (line.is_long()) return long_.add(laid_);
    // Where divisions do not part them, as where all meet in a point, they would only take memory.
    entries_ += grid_.add(laid_, entries_ < most_entries * laid_.size());
  }

  static constexpr std::size_t most_entries = 16;  // to the line

  const Nearness near_;
  Grid grid_;
  LongLines long_;
  std::size_t entries_ = 0;
  std::vector<Line> laid_;
  std::vector<std::uint32_t> asked_;  ///< by line: the question that it was last part of
  std::uint32_t asking_ = 0;
  std::vector<Stretch> covered_;
};

}  // namespace

std::vector<Segment> draw_once(const std::vector<Segment>& segments, double apart, const Execution& execution) {
  if (segments.empty()) return {};
  std::vector<std::uint32_t> order(segments.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return segments[a].rank < segments[b].rank; });
  std::vector<Segment> fresh;
  fresh.reserve(segments.size());
  Sheet sheet(Extent(segments), apart);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Segment& segment = segments[order[i]];
    if (i % 256 == 0) check_cancelled(execution);
    if (i % 4096 == 0) report_progress(execution, "strokes", 0.1 + 0.4 * double(i) / double(order.size()));
    if (glm::distance(segment.from, segment.to) > Nearness::shortest / 4) sheet.lay(Line(segment), fresh);
  }
  return fresh;
}

}  // namespace frontmost::lines_detail
