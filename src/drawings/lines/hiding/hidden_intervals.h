// SPDX-License-Identifier: Apache-2.0
// What of an edge is hidden so far, while one triangle after another is held against it.
//
//    t = 0                              1        United intervals tell what is still open, and asking ends
//    ---[======]------[===]--[========]---       where nothing is. With counts every triangle has its own
//       hidden        hidden  hidden             interval, and the number over a place is how many hide it.
//
// An edge passes cells from one end to the other, so new intervals mostly lengthen the last one or follow it; a deque
// is also quick at the other end.
#pragma once

#include <algorithm>
#include <deque>

#include "lines/hiding/occluder.h"

namespace frontmost::lines_detail {

/// United, so that it tells what is still open; or counted, one interval for each triangle.
class HiddenIntervals {
 public:
  struct Hidden {
    Interval interval;
    std::uint32_t triangle;  ///< of those that are united, the one that came first
  };

  /// Forgets all, and begins anew.
  void restart(bool counts) {
    counts_ = counts;
    hidden_.clear();
  }

  /// O(intervals) at worst; O(log intervals) where it lengthens the first or the last one, or is a new one there.
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

  /// Whether asking more can tell nothing new about a part. With counts it always can.
  [[nodiscard]] bool cover(const Interval& part) const {
    if (counts_) return false;
    const auto at = first_to(part.end);
    return at != hidden_.end() && at->interval.begin <= part.begin;
  }

  /// From the first to the last point of `part` that is still open; empty where none is.
  [[nodiscard]] Interval open_part(Interval part) const {
    if (counts_) return part;
    if (const auto at = first_to(part.begin); at != hidden_.end() && at->interval.begin <= part.begin)
      part.begin = at->interval.end;
    if (const auto at = first_to(part.end); at != hidden_.end() && at->interval.begin < part.end)
      part.end = at->interval.begin;
    return part;
  }

  /// United ones in order. With counts, a triangle that was added twice is there once.
  [[nodiscard]] const std::deque<Hidden>& intervals() {
    if (!counts_) return hidden_;
    std::sort(hidden_.begin(), hidden_.end(), [](const Hidden& a, const Hidden& b) { return a.triangle < b.triangle; });
    const auto same = [](const Hidden& a, const Hidden& b) { return a.triangle == b.triangle; };
    hidden_.erase(std::unique(hidden_.begin(), hidden_.end(), same), hidden_.end());
    return hidden_;
  }

 private:
  /// Of united ones, the first that reaches t.
  [[nodiscard]] std::deque<Hidden>::const_iterator first_to(double t) const {
    return std::lower_bound(hidden_.begin(), hidden_.end(), t,
                            [](const Hidden& hidden, double place) { return hidden.interval.end < place; });
  }

  bool counts_ = false;
  std::deque<Hidden> hidden_;  ///< cells may come from an edge's end to its beginning
};

}  // namespace frontmost::lines_detail
