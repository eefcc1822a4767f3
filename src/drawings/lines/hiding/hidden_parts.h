// SPDX-License-Identifier: Apache-2.0
// Each edge is compared with the occluders in the cells that it passes, and cut where hidden stretches begin and end.
//
// A grid of square cells lies over the picture, with about 32 triangles to the cell. Each cell lists the triangles that
// may cover some of it, the nearest first. A triangle behind another that covers the whole cell hides nothing more
// there and is left out.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <utility>
#include <vector>

#include "frontmost/lines.h"
#include "lines/hiding/occluder.h"
#include "lines/mesh/feature_edges.h"
#include "lines/square_grid.h"

namespace frontmost::lines_detail {

/// Linear on the screen; larger values are nearer.
[[nodiscard]] inline double nearness(double distance, bool is_parallel) {
  return is_parallel ? -distance : 1 / distance;
}

/// In cells; more than the rounding error of any place in the picture.
inline constexpr double kCellPad = 1e-6;

class GridPlan;

class OccluderGrid {
 public:
  /// Takes the triangles that are not seen edge-on. Unless `keeps_all`, cells omit triangles that lie wholly behind a
  /// triangle that covers the cell whole. O(triangles), with at most about 20 cells per triangle.
  OccluderGrid(const SeenMesh& seen, const View& view, bool keeps_all, const Execution& execution);

  /// A cell that a segment passes. Its occluders are the entries from `first` to `last`.
  struct Visit : PassedCell {
    std::size_t first, last;
  };

  /// Calls visit(Visit) for every cell that the segment passes, until it returns false. Both ends are in cells.
  template <class Visitor>
  void visit_cells(const glm::dvec2& from, const glm::dvec2& to, const Visitor& visit) const {
    cells_.visit_along(from, to, kCellPad, [&](const PassedCell& passed) {
      return visit(Visit{passed, first_[passed.cell], first_[passed.cell + 1]});
    });
  }

  /// The boxes of the entries from number `entry` on.
  [[nodiscard]] ScreenBoxes boxes(std::size_t entry) const {
    return {low_x_.data() + entry, low_y_.data() + entry, high_x_.data() + entry, high_y_.data() + entry,
            nearest_.data() + entry};
  }
  /// Whether the cell stores the sides of its triangles. Without sides, an edge among many parallel slanting ones would
  /// be compared with all whose boxes it meets.
  [[nodiscard]] bool has_sides(std::size_t cell) const { return first_[cell + 1] - first_[cell] >= kMany; }
  /// The sides of the entries from the cell's `offset`-th on. Precondition: has_sides().
  [[nodiscard]] ScreenSides sides(std::uint32_t cell, std::size_t offset) const {
    const std::size_t first = first_side_[cell] + offset;
    ScreenSides sides;
    for (int k = 0; k < ScreenSides::count; ++k) {
      sides.a[k] = sides_[3 * k].data() + first;
      sides.b[k] = sides_[3 * k + 1].data() + first;
      sides.c[k] = sides_[3 * k + 2].data() + first;
    }
    return sides;
  }
  [[nodiscard]] const Occluder& occluder(std::size_t entry) const { return occluders_[numbers_[entry]]; }
  /// Cells per pixel.
  [[nodiscard]] double scale() const { return scale_; }

  /// The cell with most entries, and its nearest triangle.
  struct Crowd {
    std::size_t count = 0;
    std::uint32_t triangle = no_index;
  };
  [[nodiscard]] Crowd largest_crowd() const;

 private:
  static constexpr std::size_t kMany = 512;
  void fill_cells(const GridPlan& plan);
  void fill_sides(const GridPlan& plan);

  SquareGrid cells_;
  double scale_ = 1;
  std::vector<std::size_t> first_;  ///< by cell: index of its first entry
  Buffer<float> low_x_, low_y_, high_x_, high_y_, nearest_;
  Buffer<std::uint32_t> numbers_;
  std::vector<std::size_t> first_side_;  ///< by cell
  Buffer<float> sides_[3 * ScreenSides::count];
  Buffer<Occluder> occluders_;
};

/// The scene with which edges are compared.
struct EdgeOccluders {
  const Sight& sight;
  const View& view;
  const OccluderGrid& grid;
  const ShadowKernels kernels;
  const bool counts;    ///< LineOptions::counts_hidden
  const bool outlines;  ///< LineOptions::outlines
};

/// The parts of an edge that are hidden so far, while one triangle after another is compared with it.
///
///    t = 0                              1        United intervals show which parts are still open; the search
///    ---[======]------[===]--[========]---       ends when none is. With counts, every triangle has its own
///       hidden        hidden  hidden             interval; as many triangles hide a place as intervals cover it.
class HiddenIntervals {
 public:
  struct Hidden {
    Interval interval;
    std::uint32_t triangle;  ///< the triangle that hides the interval; the first one of united intervals
  };

  /// Removes all intervals.
  void restart(bool counts) {
    counts_ = counts;
    hidden_.clear();
  }

  /// Adds an interval that `triangle` hides. O(intervals) at worst; O(log intervals) if it extends, or becomes, the
  /// first or the last interval.
  void add(Interval in, std::uint32_t triangle) {
    if (!(in.begin < in.end)) return;
    if (counts_) {
      hidden_.push_back({in, triangle});
      return;
    }
    const auto first = hidden_.begin() + (first_to(in.begin) - hidden_.begin());
    auto last = first;
    for (; last != hidden_.end() && last->interval.begin <= in.end; ++last)
      in = {std::min(in.begin, last->interval.begin), std::max(in.end, last->interval.end)};
    if (first == last) {
      hidden_.insert(first, {in, triangle});
    } else {
      first->interval = in;
      hidden_.erase(first + 1, last);
    }
  }

  /// Whether all of `part` is known to be hidden, so that more triangles add nothing. Always false with counts.
  [[nodiscard]] bool cover(const Interval& part) const {
    if (counts_) return false;
    const auto at = first_to(part.end);
    return at != hidden_.end() && at->interval.begin <= part.begin;
  }

  /// The stretch from the first to the last open point of `part`; empty if no point is open.
  [[nodiscard]] Interval open_part(Interval part) const {
    if (counts_) return part;
    if (const auto at = first_to(part.begin); at != hidden_.end() && at->interval.begin <= part.begin)
      part.begin = at->interval.end;
    if (const auto at = first_to(part.end); at != hidden_.end() && at->interval.begin < part.end)
      part.end = at->interval.begin;
    return part;
  }

  /// The united intervals, in order. With counts: one interval for each triangle, even if it was added twice.
  [[nodiscard]] const std::deque<Hidden>& intervals() {
    if (!counts_) return hidden_;
    std::sort(hidden_.begin(), hidden_.end(), [](const Hidden& a, const Hidden& b) { return a.triangle < b.triangle; });
    const auto same = [](const Hidden& a, const Hidden& b) { return a.triangle == b.triangle; };
    hidden_.erase(std::unique(hidden_.begin(), hidden_.end(), same), hidden_.end());
    return hidden_;
  }

 private:
  /// The first united interval that reaches t.
  [[nodiscard]] std::deque<Hidden>::const_iterator first_to(double t) const {
    return std::lower_bound(hidden_.begin(), hidden_.end(), t,
                            [](const Hidden& hidden, double place) { return hidden.interval.end < place; });
  }

  bool counts_ = false;
  std::deque<Hidden> hidden_;  ///< a deque, because intervals may be added at either end
};

struct EdgeSearch {
  HiddenIntervals hidden;
  OccluderBatch batch;  ///< occluders that are still to be compared with the edge
  /// The occluders that were added to a batch last, by the low bits of their addresses, so that the next cell can skip
  /// them.
  std::array<const Occluder*, 64> asked{};
  std::vector<std::pair<double, int>> changes;  ///< places where one more or one less triangle hides the edge
  std::uint64_t work = 0;                       ///< as for EdgeCutter::take_work(), over all edges
};

/// Cuts one edge after another, with the same memory. Not for several threads at once.
class EdgeCutter {
 public:
  explicit EdgeCutter(const EdgeOccluders& occlusion) : o_(occlusion) {}

  /// Appends the parts of `edge`, whose number is `number`, that lie within the view. The distances of `edge` need not
  /// be set.
  void cut(const SightedEdge& edge, std::uint32_t number, std::vector<DrawnPart>& parts);

  /// The work since the last call, in tested boxes. A batch that is compared with an edge counts as 256 boxes.
  [[nodiscard]] std::uint64_t take_work() { return std::exchange(search_.work, 0); }

 private:
  const EdgeOccluders o_;
  EdgeSearch search_;  ///< kept for its memory
};

}  // namespace frontmost::lines_detail
