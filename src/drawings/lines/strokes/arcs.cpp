// SPDX-License-Identifier: Apache-2.0
// Finds arcs and circles among the corners of a chain.
//
// An arc runs through its first, its middle and its last corner, so that it joins its neighbours. The length of a run
// is doubled while it fits, and then halved: O(n log n).
//
// Corners on a circle do not prove an arc: a long line beside a few tiny ones also has its corners there, and so has
// the flat of a shaft. So an arc may deviate from a chord only where other chords show that the circle was cut as
// coarsely.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t fewest_joins = 4;
constexpr double widest_join = 20.01 * std::numbers::pi / 180;  // of the circle; 18 to the whole
constexpr double least_turn = 10 * std::numbers::pi / 180;      // a smaller arc is drawn as a line
/// A chord that deviates by more than the tolerance needs two chords at least half as long, among the three before it
/// and the three after it. Looking at the next ones alone fails where corners of other things stand on the circle.
constexpr std::size_t reach = 3;
constexpr int fewest_alike = 2;
constexpr double alike = 0.5;

struct Circle {
  glm::dvec2 centre;
  double radius;
};

std::optional<Circle> circle_through(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const glm::dvec2 u = b - a, v = c - a;
  const double area = 2 * cross(u, v);
  if (area == 0) return std::nullopt;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v);
  const glm::dvec2 to_centre = glm::dvec2(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / area;
  return Circle{a + to_centre, glm::length(to_centre)};
}

/// The angle from one point of the circle to another, in (-pi, pi].
double turn_between(const Circle& circle, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 u = a - circle.centre, v = b - circle.centre;
  return std::atan2(cross(u, v), glm::dot(u, v));
}

/// A run of corners, open or closed to a ring.
class ChordRun {
 public:
  ChordRun(const std::vector<glm::dvec2>& points, std::size_t first, std::size_t chords)
      : points_(points), first_(first), chords_(chords) {}

  /// Whether every chord lies within `tolerance` of the arc or is evenly stepped. The circle runs through all corners
  /// within the tolerance.
  [[nodiscard]] bool is_like(const Circle& circle, double tolerance) const {
    for (std::size_t i = 0; i < chords_; ++i) {
      const double to_middle = glm::distance((corner(i) + corner(i + 1)) / 2.0, circle.centre);
      if (circle.radius - to_middle > tolerance && !is_evenly_stepped(i)) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] const glm::dvec2& corner(std::size_t i) const { return points_[(first_ + i) % points_.size()]; }
  [[nodiscard]] double length(std::size_t chord) const { return glm::distance(corner(chord), corner(chord + 1)); }
  [[nodiscard]] bool is_ring() const { return chords_ == points_.size(); }

  [[nodiscard]] bool is_evenly_stepped(std::size_t chord) const {
    const double least = alike * length(chord);
    int found = 0;
    for (std::size_t k = 1; k <= reach; ++k) {
      if (is_ring() || chord >= k) found += length((chord + chords_ - k) % chords_) >= least;
      if (is_ring() || chord + k < chords_) found += length((chord + k) % chords_) >= least;
    }
    return found >= fewest_alike;
  }

  const std::vector<glm::dvec2>& points_;
  const std::size_t first_, chords_;
};

class ArcFinder {
 public:
  ArcFinder(Chain& chain, double tolerance) : chain_(chain), points_(chain.points), tolerance_(tolerance) {}

  void run() {
    if (chain_.is_closed && make_circle()) return;
    if (chain_.is_closed) points_.push_back(points_.front());
    std::vector<glm::dvec2> kept;
    std::size_t at = 0;
    while (at + 1 < points_.size()) {
      const std::size_t end = longest_run(at);
      kept.push_back(points_[at]);
      bulges_.push_back(0);
      if (end > at) {
        add_arc(at, end, kept);
        at = end;
      } else {
        ++at;
      }
    }
    if (!chain_.is_closed) {
      kept.push_back(points_.back());
      bulges_.push_back(0);
    }
    points_ = std::move(kept);
    chain_.bulges = std::move(bulges_);
  }

 private:
  struct Fit {
    Circle circle;
    double turn;
  };

  /// The arc through the corners from `first` to `last`, if they fit.
  [[nodiscard]] std::optional<Fit> fit(std::size_t first, std::size_t last) const {
    const std::optional<Circle> circle = circle_through(points_[first], points_[(first + last) / 2], points_[last]);
    if (!circle) return std::nullopt;
    const std::optional<double> turn = turn_along(*circle, first, last);
    if (!turn || std::abs(*turn) < least_turn || std::abs(*turn) > 6.2) return std::nullopt;
    if (!ChordRun(points_, first, last - first).is_like(*circle, tolerance_)) return std::nullopt;
    return Fit{*circle, *turn};
  }

  /// The angle around the circle from corner to corner. None if a corner is off the circle or far from the next.
  [[nodiscard]] std::optional<double> turn_along(const Circle& circle, std::size_t first, std::size_t last) const {
    double turn = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (std::abs(glm::distance(points_[i], circle.centre) - circle.radius) > tolerance_) return std::nullopt;
      const double by = turn_between(circle, points_[i], points_[i + 1 == points_.size() ? 0 : i + 1]);
      if (std::abs(by) > widest_join || by * turn < 0) return std::nullopt;
      turn += by;
    }
    return turn;
  }

  [[nodiscard]] std::size_t longest_run(std::size_t first) const {
    const std::size_t most = points_.size() - 1;
    std::size_t fits = first + fewest_joins;
    if (fits > most || !fit(first, fits)) return first;
    std::size_t step = fewest_joins;
    while (fits < most && fit(first, std::min(most, fits + step))) {
      fits = std::min(most, fits + step);
      step *= 2;
    }
    for (; step > 0; step /= 2)
      if (fits + step <= most && fit(first, fits + step)) fits += step;
    return fits;
  }

  /// An arc beyond a half circle is split in two: formats differ in how they take longer ones.
  void add_arc(std::size_t first, std::size_t last, std::vector<glm::dvec2>& kept) {
    const Fit arc = *fit(first, last);
    if (std::abs(arc.turn) <= std::numbers::pi) {
      bulges_.back() = std::tan(arc.turn / 4);
      return;
    }
    const glm::dvec2 begin = points_[first] - arc.circle.centre;
    const double c = std::cos(arc.turn / 2), s = std::sin(arc.turn / 2);
    bulges_.back() = std::tan(arc.turn / 8);
    kept.push_back(arc.circle.centre + glm::dvec2(begin.x * c - begin.y * s, begin.x * s + begin.y * c));
    bulges_.push_back(std::tan(arc.turn / 8));
  }

  bool make_circle() {
    const std::size_t n = points_.size();
    if (n < 18) return false;
    const std::optional<Circle> circle = circle_through(points_[0], points_[n / 3], points_[2 * n / 3]);
    if (!circle) return false;
    const std::optional<double> turn = turn_along(*circle, 0, n);
    if (!turn || std::abs(std::abs(*turn) - 2 * std::numbers::pi) > 1e-6) return false;
    if (!ChordRun(points_, 0, n).is_like(*circle, tolerance_)) return false;
    const double bulge = *turn > 0 ? 1 : -1;
    points_ = {points_[0], 2.0 * circle->centre - points_[0]};
    chain_.bulges = {bulge, bulge};
    return true;
  }

  Chain& chain_;
  std::vector<glm::dvec2>& points_;
  const double tolerance_;
  std::vector<double> bulges_;
};

}  // namespace

void find_arcs(Chain& chain, double tolerance) {
  if (chain.points.size() > fewest_joins) ArcFinder(chain, tolerance).run();
}

}  // namespace frontmost::lines_detail
