// SPDX-License-Identifier: Apache-2.0
// Segments are joined to chains. Then corners are removed from the chains, and runs of chords become arcs.
//
// Corners are removed with a cone from the last corner that stayed. The cone holds the directions that pass every point
// since then at less than the tolerance. An arc runs through the first, the middle and the last corner of a run.
//
//            . - '       p4 lies outside of the cone: p3 becomes
//    p0 <====.  p2  p3   a corner, and a new cone begins there
//            ' - .    p4
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

/// An end of a segment: number 2 i for `from`, 2 i + 1 for `to`.
struct SegmentEnd {
  std::uint32_t rank;
  std::int64_t x, y;
  std::uint32_t number;

  [[nodiscard]] bool meets(const SegmentEnd& o) const { return rank == o.rank && x == o.x && y == o.y; }
  friend auto operator<=>(const SegmentEnd&, const SegmentEnd&) = default;
};

constexpr double straight_on = 0.9659;       // the cosine of 15 degrees
constexpr std::size_t most_at_junction = 8;  // bounds the search, which is cubic

/// Pairs the ends of a junction whose lines go on nearly straight, the straightest pairs first.
void pair_straight(const std::vector<LineSegment>& segments, std::span<const SegmentEnd> ends,
                   std::vector<std::uint32_t>& partner) {
  if (ends.size() > most_at_junction) return;
  const auto direction = [&](const SegmentEnd& end) {
    const LineSegment& s = segments[end.number / 2];
    const glm::dvec2 along = end.number % 2 == 0 ? s.to - s.from : s.from - s.to;
    return along / glm::length(along);
  };
  for (;;) {
    double best = straight_on;
    const SegmentEnd *a = nullptr, *b = nullptr;
    for (const SegmentEnd& one : ends)
      for (const SegmentEnd& other : ends) {
        if (one.number >= other.number || partner[one.number] != no_index || partner[other.number] != no_index)
          continue;
        const double cosine = -glm::dot(direction(one), direction(other));
        if (cosine > best) best = cosine, a = &one, b = &other;
      }
    if (a == nullptr) return;
    partner[a->number] = b->number;
    partner[b->number] = a->number;
  }
}

/// By end: the end that it goes on with, or no_index. Two ends that meet alone go on with each other; of more, with
/// `through_junctions`, those that are nearly straight.
std::vector<std::uint32_t> partners(const std::vector<LineSegment>& segments, bool through_junctions) {
  std::vector<SegmentEnd> ends;
  ends.reserve(2 * segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      const glm::dvec2& p = k == 0 ? segments[i].from : segments[i].to;
      ends.push_back({segments[i].rank, std::llround(p.x * places_per_pixel), std::llround(p.y * places_per_pixel),
                      std::uint32_t(2 * i) + std::uint32_t(k)});
    }
  std::sort(ends.begin(), ends.end());
  std::vector<std::uint32_t> partner(ends.size(), no_index);
  for (std::size_t first = 0; first < ends.size();) {
    std::size_t last = first + 1;
    while (last < ends.size() && ends[last].meets(ends[first])) ++last;
    if (last - first == 2) {
      partner[ends[first].number] = ends[first + 1].number;
      partner[ends[first + 1].number] = ends[first].number;
    } else if (last - first > 2 && through_junctions) {
      pair_straight(segments, {&ends[first], last - first}, partner);
    }
    first = last;
  }
  return partner;
}

/// Rotates a closed chain so that no arc and no straight line runs across its beginning: to its sharpest corner or,
/// where all are blunt, to the end of its longest line.
void is_lower_end_corner(std::vector<glm::dvec2>& points) {
  constexpr double blunt = 0.866;  // the cosine of 30 degrees
  double least = blunt, longest = 0;
  std::size_t sharpest = points.size(), end_of_longest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 before = points[i] - points[(i + points.size() - 1) % points.size()],
                     after = points[(i + 1) % points.size()] - points[i];
    const double length = glm::length(before), cosine = glm::dot(before, after) / (length * glm::length(after));
    if (cosine < least) {
      least = cosine;
      sharpest = i;
    }
    if (length > longest) {
      longest = length;
      end_of_longest = i;
    }
  }
  const std::size_t begin = sharpest < points.size() ? sharpest : end_of_longest;
  std::rotate(points.begin(), points.begin() + std::ptrdiff_t(begin), points.end());
}

/// The directions of the lines from `tip` that pass all points so far within the tolerance.
struct Cone {
  [[nodiscard]] bool holds(const glm::dvec2& p) const {
    const glm::dvec2 d = p - tip;
    return is_open || (cross(right, d) >= 0 && cross(d, left) >= 0 && glm::dot(d, d) >= farthest);
  }
  void narrow(const glm::dvec2& p, double tolerance) {
    const glm::dvec2 d = p - tip;
    const double length = glm::length(d);
    if (length <= tolerance) return;
    const glm::dvec2 side = glm::dvec2(-d.y, d.x) * (tolerance / length);
    if (is_open || cross(right, d - side) > 0) right = d - side;
    if (is_open || cross(d + side, left) > 0) left = d + side;
    farthest = length * length;  // so that a line that turns back keeps its corner
    is_open = false;
  }

  glm::dvec2 tip, left{0}, right{0};
  double farthest = 0;
  bool is_open = true;
};

constexpr std::size_t fewest_joins = 4;
constexpr double widest_join = 20.01 * std::numbers::pi / 180;  // angle of an arc; 18 such joins make a whole circle
constexpr double least_turn = 10 * std::numbers::pi / 180;      // a smaller arc is drawn as a line
/// A chord that deviates from the arc by more than the tolerance is evenly stepped if, among the three chords before it
/// and the three after it, two are at least half as long. Its two neighbours alone do not suffice, because corners of
/// other lines may divide them.
constexpr std::size_t most_steps = 3;
constexpr int fewest_alike = 2;
constexpr double alike = 0.5;

struct Circle {
  glm::dvec2 centre;
  double radius;

  /// The angle from one point to another, in (-pi, pi].
  [[nodiscard]] double turn_between(const glm::dvec2& a, const glm::dvec2& b) const {
    const glm::dvec2 u = a - centre, v = b - centre;
    return std::atan2(cross(u, v), glm::dot(u, v));
  }
};

std::optional<Circle> circle_through(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const glm::dvec2 u = b - a, v = c - a;
  const double area = 2 * cross(u, v);
  if (area == 0) return std::nullopt;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v);
  const glm::dvec2 to_centre = glm::dvec2(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / area;
  return Circle{a + to_centre, glm::length(to_centre)};
}

struct ArcFinder {
  void run() {
    if (chain.is_closed && make_circle()) return;
    if (chain.is_closed) points.push_back(points.front());
    std::vector<glm::dvec2> kept;
    std::size_t at = 0;
    while (at + 1 < points.size()) {
      const std::size_t end =
          longest_run(at, fewest_joins, points.size() - 1, [&](std::size_t last) { return fit(at, last).has_value(); });
      kept.push_back(points[at]);
      bulges.push_back(0);
      if (end > at) add_arc(at, end, kept);
      at = std::max(at + 1, end);
    }
    if (!chain.is_closed) {
      kept.push_back(points.back());
      bulges.push_back(0);
    }
    points = std::move(kept);
    chain.bulges = std::move(bulges);
  }

  struct Fit {
    Circle circle;
    double turn;
  };

  /// The arc through the corners from `first` to `last`, if they fit.
  [[nodiscard]] std::optional<Fit> fit(std::size_t first, std::size_t last) const {
    const std::optional<Circle> circle = circle_through(points[first], points[(first + last) / 2], points[last]);
    if (!circle) return std::nullopt;
    const std::optional<double> turn = turn_along(*circle, first, last);
    if (!turn || std::abs(*turn) < least_turn || std::abs(*turn) > 6.2) return std::nullopt;
    if (!follow(*circle, first, last - first)) return std::nullopt;
    return Fit{*circle, *turn};
  }

  /// The angle around the circle. None if a corner is off the circle or far from the next.
  [[nodiscard]] std::optional<double> turn_along(const Circle& circle, std::size_t first, std::size_t last) const {
    double turn = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (std::abs(glm::distance(points[i], circle.centre) - circle.radius) > tolerance) return std::nullopt;
      const double by = circle.turn_between(points[i], points[i + 1 == points.size() ? 0 : i + 1]);
      if (std::abs(by) > widest_join || by * turn < 0) return std::nullopt;
      turn += by;
    }
    return turn;
  }

  /// Whether each of the chords from corner `first` on lies within the tolerance of the arc, or has a length like its
  /// neighbours. Precondition: all corners lie within the tolerance of the circle. All chords of the chain are a ring.
  [[nodiscard]] bool follow(const Circle& circle, std::size_t first, std::size_t chords) const {
    const bool is_ring = chords == points.size();
    const auto corner = [&](std::size_t i) { return points[(first + i) % points.size()]; };
    const auto length = [&](std::size_t chord) { return glm::distance(corner(chord), corner(chord + 1)); };
    for (std::size_t i = 0; i < chords; ++i) {
      const double to_middle = glm::distance((corner(i) + corner(i + 1)) / 2.0, circle.centre);
      if (!(circle.radius - to_middle > tolerance)) continue;
      const double least = alike * length(i);
      int found = 0;
      for (std::size_t k = 1; k <= most_steps; ++k) {
        if (is_ring || i >= k) found += length((i + chords - k) % chords) >= least;
        if (is_ring || i + k < chords) found += length((i + k) % chords) >= least;
      }
      if (found < fewest_alike) return false;
    }
    return true;
  }

  /// Adds the arc of a run. An arc of more than a half circle is split in two, because formats differ in how they treat
  /// longer arcs.
  void add_arc(std::size_t first, std::size_t last, std::vector<glm::dvec2>& kept) {
    const Fit arc = *fit(first, last);
    if (std::abs(arc.turn) <= std::numbers::pi) {
      bulges.back() = std::tan(arc.turn / 4);
      return;
    }
    const glm::dvec2 begin = points[first] - arc.circle.centre;
    const double c = std::cos(arc.turn / 2), s = std::sin(arc.turn / 2);
    bulges.back() = std::tan(arc.turn / 8);
    kept.push_back(arc.circle.centre + glm::dvec2(begin.x * c - begin.y * s, begin.x * s + begin.y * c));
    bulges.push_back(std::tan(arc.turn / 8));
  }

  bool make_circle() {
    const std::size_t n = points.size();
    if (n < 18) return false;
    const std::optional<Circle> circle = circle_through(points[0], points[n / 3], points[2 * n / 3]);
    if (!circle) return false;
    const std::optional<double> turn = turn_along(*circle, 0, n);
    if (!turn || std::abs(std::abs(*turn) - 2 * std::numbers::pi) > 1e-6) return false;
    if (!follow(*circle, 0, n)) return false;
    const double bulge = *turn > 0 ? 1 : -1;
    points = {points[0], 2.0 * circle->centre - points[0]};
    chain.bulges = {bulge, bulge};
    return true;
  }

  Chain& chain;
  const double tolerance;
  std::vector<glm::dvec2>& points = chain.points;
  std::vector<double> bulges{};
};

}  // namespace

std::vector<Chain> chained(const std::vector<LineSegment>& segments, bool through_junctions) {
  std::vector<Chain> chains;
  const auto place = [&](std::uint32_t end) { return end % 2 == 0 ? segments[end / 2].from : segments[end / 2].to; };
  for_each_chain(partners(segments, through_junctions), [&](const std::vector<std::uint32_t>& ends, bool is_closed) {
    Chain& chain = chains.emplace_back();
    chain.rank = segments[ends[0] / 2].rank;
    chain.is_closed = is_closed;
    chain.points.push_back(place(ends[0]));
    for (const std::uint32_t end : ends) {
      chain.is_contour |= segments[end / 2].is_contour;
      chain.points.push_back(place(end ^ 1));
    }
    if (is_closed) chain.points.pop_back();
  });
  std::stable_sort(chains.begin(), chains.end(), [](const Chain& a, const Chain& b) { return a.rank < b.rank; });
  return chains;
}

void straighten(Chain& chain, double tolerance) {
  std::vector<glm::dvec2>& points = chain.points;
  if (points.size() < 3) return;
  if (chain.is_closed) {
    is_lower_end_corner(points);
    points.push_back(points.front());
  }
  std::vector<glm::dvec2> kept = {points.front()};
  Cone cone{kept.back()};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!cone.holds(points[i])) {
      kept.push_back(points[i - 1]);
      cone = {kept.back()};
    }
    cone.narrow(points[i], tolerance);
  }
  if (!chain.is_closed) kept.push_back(points.back());
  points = std::move(kept);
  // Such a chain runs along a line and back again.
  if (chain.is_closed && points.size() == 2) chain.is_closed = false;
}

void find_arcs(Chain& chain, double tolerance) {
  if (chain.points.size() > fewest_joins) ArcFinder{chain, tolerance}.run();
}

}  // namespace frontmost::lines_detail
