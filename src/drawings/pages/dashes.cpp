// SPDX-License-Identifier: Apache-2.0
// Turns dashes into paths of their own. A path is measured from corner to corner. Between two corners the pattern is
// stretched so that it begins and ends with a dash (ISO 128-2, 5.2), which then meets the next one around the corner.
//
//   corner                                     corner
//     +-----  -----  -----  -----  -----  -------+        one span: a whole number of periods, and one more dash
//                                                |
//                                                |        around the corner the two dashes are one path
//   around a closed path without corners, the pattern goes a whole number of times
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "pages/formats.h"

namespace frontmost {
namespace {

using detail::Arc;
using detail::Join;

constexpr double sharp = 0.906;  // the cosine of 25 degrees: arcs and their chords turn by less
constexpr std::size_t most_dashes = 20'000'000;

struct Span {
  double begin, end;
};

/// A path whose points are addressed by their distance along the path.
struct Ruler {
  struct Leg {
    Join join;
    std::optional<Arc> arc;
    double begin, length;
  };

  Ruler(const PageGroup& group, const PagePath& path) : is_closed(path.is_closed) {
    for (std::uint32_t i = 0; i < detail::join_count(path); ++i) {
      const Join join = detail::join_of(group, path, i);
      Leg leg{join, detail::arc_between(join.from, join.to, join.bulge), length, 0};
      leg.length = leg.arc ? leg.arc->radius * std::abs(leg.arc->turn) : glm::distance(join.from, join.to);
      length += leg.length;
      if (leg.length > 0) legs.push_back(leg);
    }
  }

  /// The spans from corner to corner. The first span of a closed path begins at its first corner; without corners, a
  /// closed path has no spans.
  [[nodiscard]] std::vector<Span> spans() const {
    std::vector<double> corners;
    if (!is_closed) corners.push_back(0);
    for (std::size_t i = is_closed ? 0 : 1; i < legs.size(); ++i) {
      const Leg& before = legs[i == 0 ? legs.size() - 1 : i - 1];
      if (glm::dot(direction(before, true), direction(legs[i], false)) < sharp) corners.push_back(legs[i].begin);
    }
    if (!is_closed)
      corners.push_back(length);
    else if (!corners.empty())
      corners.push_back(corners.front() + length);
    std::vector<Span> spans;
    for (std::size_t i = 1; i < corners.size(); ++i) spans.push_back({corners[i - 1], corners[i]});
    return spans;
  }

  /// Adds the part of the path within the span to `group`, as a path of its own. On a closed path, the span may cross
  /// the path's end once.
  void cut(const Span& span, PageGroup& group) const {
    PagePath path{std::uint32_t(group.points.size()), 0, false};
    for (int round = 0; round < (is_closed ? 2 : 1); ++round)
      for (auto leg = first_leg(span.begin - round * length); leg != legs.end(); ++leg) {
        const double start = leg->begin + round * length;
        if (start >= span.end) break;
        const double begin = std::max(span.begin - start, 0.0), end = std::min(span.end - start, leg->length);
        if (!(begin < end)) continue;
        const double share = (end - begin) / leg->length;
        if (group.points.size() == path.first) add(group, at(*leg, begin));
        if (leg->arc) group.bulges.back() = std::tan(leg->arc->turn * share / 4);
        add(group, at(*leg, end));
      }
    path.count = std::uint32_t(group.points.size()) - path.first;
    if (path.count > 0) group.paths.push_back(path);
  }

  /// The last leg that begins at `along` or before; the first leg if there is none.
  [[nodiscard]] std::vector<Leg>::const_iterator first_leg(double along) const {
    const auto after = std::upper_bound(legs.begin(), legs.end(), along,
                                        [](double place, const Leg& leg) { return place < leg.begin; });
    return after == legs.begin() ? after : after - 1;
  }

  static void add(PageGroup& group, const glm::dvec2& point) {
    group.points.push_back(point);
    group.bulges.push_back(0);
  }

  [[nodiscard]] static glm::dvec2 at(const Leg& leg, double along) {
    // The ends are exact, to the bit.
    if (along <= 0) return leg.join.from;
    if (along >= leg.length) return leg.join.to;
    if (!leg.arc) return leg.join.from + (leg.join.to - leg.join.from) * (along / leg.length);
    const double angle = leg.arc->begin + leg.arc->turn * (along / leg.length);
    return leg.arc->centre + leg.arc->radius * glm::dvec2(std::cos(angle), std::sin(angle));
  }

  [[nodiscard]] static glm::dvec2 direction(const Leg& leg, bool at_end) {
    if (!leg.arc) return glm::normalize(leg.join.to - leg.join.from);
    const double angle = leg.arc->begin + (at_end ? leg.arc->turn : 0);
    return std::copysign(1.0, leg.arc->turn) * glm::dvec2(-std::sin(angle), std::cos(angle));
  }

  const bool is_closed;
  std::vector<Leg> legs;
  double length = 0;
};

/// The dash pattern of a pen: a dash, a gap, a dash and so on.
class Pattern {
 public:
  explicit Pattern(const std::vector<double>& dashes) : dashes_(dashes) {
    for (const double dash : dashes) period_ += dash;
  }

  /// The approximate number of dashes on a line of length `length`.
  [[nodiscard]] double count_on(double length) const { return length / period_ * double(dashes_.size() / 2); }

  /// Appends the dashes of a span. The span begins and ends with the pattern's first dash; a span too short for a gap
  /// is one dash.
  void fill(const Span& span, std::vector<Span>& drawn) const {
    const double length = span.end - span.begin, times = std::round((length - dashes_[0]) / period_);
    if (times < 1) return append(span, drawn);
    const double stretch = length / (times * period_ + dashes_[0]);
    double at = span.begin;
    for (double k = 0; k < times; ++k) at = draw_period(at, stretch, drawn);
    append({at, span.end}, drawn);
  }

  /// Appends dashes all around a closed line without corners.
  void fill_around(double length, std::vector<Span>& drawn) const {
    const double times = std::max(1.0, std::round(length / period_));
    double at = 0;
    for (double k = 0; k < times; ++k) at = draw_period(at, length / (times * period_), drawn);
  }

 private:
  double draw_period(double at, double stretch, std::vector<Span>& drawn) const {
    for (std::size_t i = 0; i < dashes_.size(); ++i) {
      const double end = at + dashes_[i] * stretch;
      if (i % 2 == 0) append({at, end}, drawn);
      at = end;
    }
    return at;
  }

  /// Appends a dash. If the last dash ends where the new one begins, around a corner, the last dash is extended
  /// instead.
  static void append(const Span& span, std::vector<Span>& drawn) {
    if (!drawn.empty() && drawn.back().end == span.begin)
      drawn.back().end = span.end;
    else
      drawn.push_back(span);
  }

  const std::vector<double>& dashes_;
  double period_ = 0;
};

/// The spans of a path that are drawn as dashes.
std::vector<Span> drawn_of(const Ruler& ruler, const Pattern& pattern) {
  const std::vector<Span> spans = ruler.spans();
  std::vector<Span> drawn;
  for (const Span& span : spans) pattern.fill(span, drawn);
  if (spans.empty()) pattern.fill_around(ruler.length, drawn);
  // The last dash of a closed path continues in the first.
  if (ruler.is_closed && drawn.size() > 1 && drawn.back().end == drawn.front().begin + ruler.length) {
    drawn.back().end = drawn.front().end + ruler.length;
    drawn.erase(drawn.begin());
  }
  return drawn;
}

/// Turns the dashes of a group, at most `most` of them, into paths.
PageGroup with_cut_dashes(const PageGroup& group, std::size_t most, const Execution& execution) {
  const Pattern pattern(group.pen.dashes);
  PageGroup cut{group.name, group.pen};
  cut.texts = group.texts;
  cut.pen.dashes.clear();
  std::size_t steps = 0;
  const auto poll = [&] {  // only sometimes, because a check takes longer than a dash
    if (++steps % 1024 == 0) check_cancelled(execution);
  };
  for (const PagePath& path : group.paths) {
    poll();
    const Ruler ruler(group, path);
    if (ruler.legs.empty()) {  // a dot
      cut.paths.push_back({std::uint32_t(cut.points.size()), 1, false});
      cut.points.push_back(group.points[path.first]);
      cut.bulges.push_back(0);
      continue;
    }
    if (double(cut.paths.size()) + pattern.count_on(ruler.length) > double(most))
      throw Error(ErrorCode::limit_exceeded, "dashes", "more than 20000000 of them");
    for (const Span& span : drawn_of(ruler, pattern)) {
      poll();
      ruler.cut(span, cut);
    }
  }
  if (group.bulges.empty()) cut.bulges.clear();
  return cut;
}

}  // namespace

Page with_real_dashes(Page page, const Execution& execution) {
  validate(page);
  check_cancelled(execution);
  std::size_t dashes = 0;
  for (PageLayer& layer : page.layers)
    for (PageGroup& group : layer.groups) {
      if (group.pen.dashes.empty() || !group.fills.empty()) continue;
      group = with_cut_dashes(group, most_dashes - std::min(dashes, most_dashes), execution);
      dashes += group.paths.size();
    }
  return page;
}

}  // namespace frontmost
