// SPDX-License-Identifier: Apache-2.0
// Lines that lie on each other are drawn once.
//
// Segments are laid down by rank, each without what lies there already. What could lie there is found in the cells of a
// grid: about one segment to the cell, and where more come together, as in a detailed part of a large scene, the cell
// becomes a grid itself.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/parallel.h"
#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

/// Pixels. Places of one point differ by the rounding of floats, 1e-7 of some thousand pixels.
constexpr double near = 2e-3;
constexpr double shortest = 4 * near;  // of what is left, and of what is taken away

struct Interval {
  double begin, end;
};

/// Where, along `segment`, `other` lies on it; empty where it does not. Lengths in pixels.
Interval overlap(const Segment& segment, const Segment& other) {
  constexpr Interval nothing{0, 0};
  const glm::dvec2 along = glm::normalize(segment.to - segment.from);
  const glm::dvec2 a = other.from - segment.from, b = other.to - segment.from;
  const double a_at = glm::dot(along, a), b_at = glm::dot(along, b);
  const double begin = std::max(0.0, std::min(a_at, b_at));
  const double end = std::min(glm::distance(segment.from, segment.to), std::max(a_at, b_at));
  if (!(end - begin > shortest)) return nothing;
  const double a_off = cross(along, a), slope = (cross(along, b) - a_off) / (b_at - a_at);
  const auto off = [&](double at) { return std::abs(a_off + slope * (at - a_at)); };
  return off(begin) <= near && off(end) <= near ? Interval{begin, end} : nothing;
}

/// Square cells; crowded ones are divided again.
class Grid {
 public:
  struct Cell {
    std::vector<std::uint32_t> segments;
    std::unique_ptr<Grid> finer;  ///< has them instead
  };

  Grid(const glm::dvec2& low, double cell, const glm::ivec2& count)
      : low_(low), cell_(cell), count_(count), cells_(std::size_t(count.x) * std::size_t(count.y)) {}

  /// Calls visit(segments) for every undivided cell that the segment passes, with `near` to spare.
  template <class Visit>
  void for_each_cell(const Segment& s, const Visit& visit) const {
    for_each(s, [&](std::size_t number, const glm::ivec2&) {
      const Cell& cell = cells_[number];
      if (cell.finer)
        cell.finer->for_each_cell(s, visit);
      else
        visit(cell.segments);
    });
  }

  /// Adds the last of the segments `laid`. \returns how many entries of cells are new.
  std::size_t add(const std::vector<Segment>& laid, bool may_divide) {
    const auto number = std::uint32_t(laid.size() - 1);
    std::size_t entries = 0;
    for_each(laid[number], [&](std::size_t i, const glm::ivec2& at) {
      Cell& cell = cells_[i];
      if (!cell.finer && may_divide && cell.segments.size() >= crowd && cell_ > finest * divisions)
        entries += divide(cell, at, laid);
      if (cell.finer) {
        entries += cell.finer->add(laid, may_divide);
      } else {
        cell.segments.push_back(number);
        ++entries;
      }
    });
    return entries;
  }

 private:
  static constexpr std::size_t crowd = 256;
  static constexpr int divisions = 8;
  static constexpr double finest = 8 * near;

  std::size_t divide(Cell& cell, const glm::ivec2& at, const std::vector<Segment>& laid) {
    std::size_t entries = 0;
    cell.finer = std::make_unique<Grid>(low_ + glm::dvec2(at) * cell_, cell_ / divisions, glm::ivec2(divisions));
    for (const std::uint32_t number : cell.segments)
      cell.finer->for_each(laid[number], [&](std::size_t i, const glm::ivec2&) {
        cell.finer->cells_[i].segments.push_back(number);
        ++entries;
      });
    cell.segments = {};
    return entries;
  }

  [[nodiscard]] int column(double x) const { return std::clamp(int((x - low_.x) / cell_), 0, count_.x - 1); }
  [[nodiscard]] int row(double y) const { return std::clamp(int((y - low_.y) / cell_), 0, count_.y - 1); }

  /// Column by column, the rows that the segment passes there.
  template <class Visit>
  void for_each(const Segment& s, const Visit& visit) const {
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

  const glm::dvec2 low_;
  const double cell_;
  const glm::ivec2 count_;
  std::vector<Cell> cells_;
};

/// A grid for so many segments. Precondition: not empty.
Grid grid_for(const std::vector<Segment>& segments) {
  glm::dvec2 low(1e300), high(-1e300);
  double length = 0;
  for (const Segment& s : segments) {
    low = glm::min(low, glm::min(s.from, s.to));
    high = glm::max(high, glm::max(s.from, s.to));
    length += glm::distance(s.from, s.to);
  }
  const auto count = double(segments.size());
  const double extent = std::max({high.x - low.x, high.y - low.y, 1e-6});
  // Never finer than what counts as one place: a drawing of one point would have ten million cells a side.
  const double cell = std::max({length / count, extent / std::sqrt(count), extent / 4096, 8 * near});
  return {low - near, cell, glm::ivec2((high - low + 2 * near) / cell) + 1};
}

class Sheet {
 public:
  /// Precondition: not empty.
  explicit Sheet(const std::vector<Segment>& segments) : grid_(grid_for(segments)) {}

  /// Adds what of `segment` is not there yet to `fresh`.
  void lay(const Segment& segment, std::vector<Segment>& fresh) {
    const double length = glm::distance(segment.from, segment.to);
    covered_.clear();
    ++asking_;
    grid_.for_each_cell(segment, [&](const std::vector<std::uint32_t>& cell) {
      for (const std::uint32_t other : cell) {
        if (asked_[other] == asking_) continue;
        asked_[other] = asking_;
        const Interval there = overlap(segment, laid_[other]);
        if (there.end > there.begin) covered_.push_back(there);
      }
    });
    if (covered_.empty()) return add(segment, fresh);
    std::sort(covered_.begin(), covered_.end(), [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
    covered_.push_back({length, length});
    const glm::dvec2 along = (segment.to - segment.from) / length;
    double at = 0;
    for (const Interval& c : covered_) {
      if (c.begin - at > shortest) {
        // The segment's own ends to the bit, so that its neighbours find them.
        const glm::dvec2 from = at == 0 ? segment.from : segment.from + along * at;
        const glm::dvec2 to = c.begin == length ? segment.to : segment.from + along * c.begin;
        add({from, to, segment.rank}, fresh);
      }
      at = std::max(at, c.end);
    }
  }

 private:
  void add(const Segment& segment, std::vector<Segment>& fresh) {
    fresh.push_back(segment);
    laid_.push_back(segment);
    asked_.push_back(0);
    // Where divisions do not part them, as where all meet in a point, they would only take memory.
    entries_ += grid_.add(laid_, entries_ < most_entries * laid_.size());
  }

  static constexpr std::size_t most_entries = 16;  // to the segment

  Grid grid_;
  std::size_t entries_ = 0;
  std::vector<Segment> laid_;
  std::vector<std::uint32_t> asked_;  ///< by segment: the question that it was last part of
  std::uint32_t asking_ = 0;
  std::vector<Interval> covered_;
};

}  // namespace

std::vector<Segment> draw_once(const std::vector<Segment>& segments, const Execution& execution) {
  if (segments.empty()) return {};
  std::vector<std::uint32_t> order(segments.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return segments[a].rank < segments[b].rank; });
  std::vector<Segment> fresh;
  fresh.reserve(segments.size());
  Sheet sheet(segments);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Segment& segment = segments[order[i]];
    if (i % 4096 == 0) {
      check_cancelled(execution);
      report_progress(execution, "strokes", 0.1 + 0.4 * double(i) / double(order.size()));
    }
    if (glm::distance(segment.from, segment.to) > near) sheet.lay(segment, fresh);
  }
  return fresh;
}

}  // namespace frontmost::lines_detail
