// SPDX-License-Identifier: Apache-2.0
// Each edge is compared with the occluders in the cells that it passes, and cut where hidden stretches begin and end.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <utility>
#include <vector>

#include "frontmost/lines.h"
#include "lines/hiding/occluder.h"
#include "lines/hiding/occluder_grid.h"
#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {

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

  /// O(intervals) at worst; O(log intervals) where the interval lengthens the first or last one, or becomes it.
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

  /// The stretch from the first to the last open point of `part`; empty where none is open.
  [[nodiscard]] Interval open_part(Interval part) const {
    if (counts_) return part;
    if (const auto at = first_to(part.begin); at != hidden_.end() && at->interval.begin <= part.begin)
      part.begin = at->interval.end;
    if (const auto at = first_to(part.end); at != hidden_.end() && at->interval.begin < part.end)
      part.end = at->interval.begin;
    return part;
  }

  /// United intervals in order. With counts, a triangle that was added twice occurs once.
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
  std::deque<Hidden> hidden_;  ///< a deque: cells may come from either end of the edge
};

struct EdgeSearch {
  HiddenIntervals hidden;
  OccluderBatch batch;  ///< occluders that are still to be compared with the edge
  /// The occluders that were asked last, by the low bits of their addresses, so that the next cell can skip them.
  std::array<const Occluder*, 64> asked{};
  std::vector<std::pair<double, int>> changes;  ///< places where one more or one less triangle hides the edge
  std::uint64_t boxes = 0;                      ///< number of occluder boxes that were tested, over all edges
  std::uint64_t batches = 0;                    ///< number of batches of occluders that were compared with edges
};

/// Cuts one edge after another, with the same memory. Not for several threads at once.
class EdgeCutter {
 public:
  explicit EdgeCutter(const EdgeOccluders& occlusion) : o_(occlusion) {}

  /// Appends the parts of `edge`, whose number is `number`, that lie within the view. Its distances need not be set.
  void cut(const SightedEdge& edge, std::uint32_t number, std::vector<DrawnPart>& parts);

  /// The work since the last call, in tested boxes. A batch that is compared with an edge counts as 256 boxes.
  [[nodiscard]] std::uint64_t take_work() {
    const std::uint64_t work = search_.boxes + 256 * search_.batches;
    return work - std::exchange(told_, work);
  }

 private:
  const EdgeOccluders o_;
  EdgeSearch search_;  ///< kept for its memory
  std::uint64_t told_ = 0;
};

}  // namespace frontmost::lines_detail
