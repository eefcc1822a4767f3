// SPDX-License-Identifier: Apache-2.0
// The parts of an edge that are hidden so far, while one triangle after another is compared with it.
//
//    t = 0                              1        United intervals show which parts are still open; the search
//    ---[======]------[===]--[========]---       ends when none is. With counts, every triangle has its own
//       hidden        hidden  hidden             interval; as many triangles hide a place as intervals cover it.
//
// An edge passes cells from one end to the other, so new intervals mostly lengthen the last one or follow it. A deque
// is also quick at the other end.
#pragma once

#include <algorithm>
#include <deque>

#include "lines/hiding/occluder.h"

namespace frontmost::lines_detail {

/// United intervals, which show what is still open; or, with counts, one interval for each triangle.
class HiddenIntervals {
 public:
  struct Hidden {
    Interval interval;
    std::uint32_t triangle;  ///< of united intervals, the triangle that came first
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
  std::deque<Hidden> hidden_;  ///< a deque, because cells may come from an edge's end to its beginning
};

}  // namespace frontmost::lines_detail
