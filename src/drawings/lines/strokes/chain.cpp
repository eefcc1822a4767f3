// SPDX-License-Identifier: Apache-2.0
// Joins segments to chains, and removes corners from them.
//
// Ends are rounded to a thousandth of a pixel and sorted. Two ends of one rank at one place, and no third, are joined.
// Where more meet, all of them end, since the continuation would be a guess.
//
// Corners are removed with a cone from the last corner that stayed. The cone holds the directions that pass every point
// since then at less than the tolerance.
//
//            . - '       p4 lies outside of the cone: p3 becomes
//    p0 <====.  p2  p3   a corner, and a new cone begins there
//            ' - .    p4
#include <algorithm>
#include <cmath>

#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::uint32_t none = no_index;

/// An end of a segment: number 2 i for `from`, 2 i + 1 for `to`.
struct SegmentEnd {
  std::int64_t x, y;
  std::uint32_t rank, number;

  [[nodiscard]] bool meets(const SegmentEnd& o) const { return rank == o.rank && x == o.x && y == o.y; }
  friend bool operator<(const SegmentEnd& a, const SegmentEnd& b) {
    if (a.rank != b.rank) return a.rank < b.rank;
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.number < b.number;
  }
};

/// By end: the only other end that it meets, or none.
std::vector<std::uint32_t> partners(const std::vector<LineSegment>& segments) {
  std::vector<SegmentEnd> ends;
  ends.reserve(2 * segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      const glm::dvec2& p = k == 0 ? segments[i].from : segments[i].to;
      ends.push_back({std::llround(p.x * places_per_pixel), std::llround(p.y * places_per_pixel), segments[i].rank,
                      std::uint32_t(2 * i) + std::uint32_t(k)});
    }
  std::sort(ends.begin(), ends.end());
  std::vector<std::uint32_t> partner(ends.size(), none);
  for (std::size_t first = 0; first < ends.size();) {
    std::size_t last = first + 1;
    while (last < ends.size() && ends[last].meets(ends[first])) ++last;
    if (last - first == 2) {
      partner[ends[first].number] = ends[first + 1].number;
      partner[ends[first + 1].number] = ends[first].number;
    }
    first = last;
  }
  return partner;
}

class Chaining {
 public:
  explicit Chaining(const std::vector<LineSegment>& segments)
      : segments_(segments), partner_(partners(segments)), is_used_(segments.size()) {}

  std::vector<Chain> run() {
    for (std::uint32_t end = 0; end < partner_.size(); ++end)
      if (partner_[end] == none && !is_used_[end / 2]) follow(end);
    for (std::uint32_t end = 0; end < partner_.size(); end += 2)
      if (!is_used_[end / 2]) follow(end);
    std::stable_sort(chains_.begin(), chains_.end(), [](const Chain& a, const Chain& b) { return a.rank < b.rank; });
    return std::move(chains_);
  }

 private:
  [[nodiscard]] const glm::dvec2& place(std::uint32_t end) const {
    return end % 2 == 0 ? segments_[end / 2].from : segments_[end / 2].to;
  }

  /// Appends the chain from this end to the next end without a partner, or once around.
  void follow(std::uint32_t end) {
    Chain chain;
    chain.rank = segments_[end / 2].rank;
    chain.points.push_back(place(end));
    while (end != none && !is_used_[end / 2]) {
      is_used_[end / 2] = true;
      chain.is_contour |= segments_[end / 2].is_contour;
      chain.points.push_back(place(end ^ 1));
      end = partner_[end ^ 1];
    }
    chain.is_closed = end != none;
    if (chain.is_closed) chain.points.pop_back();
    chains_.push_back(std::move(chain));
  }

  const std::vector<LineSegment>& segments_;
  std::vector<std::uint32_t> partner_;
  std::vector<bool> is_used_;
  std::vector<Chain> chains_;
};

/// Rotates a closed chain so that no arc and no straight line runs across its beginning. It then begins at its sharpest
/// corner or, where all are blunt, at the end of its longest line.
void begin_at_corner(std::vector<glm::dvec2>& points) {
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

/// The directions from `tip` that pass all points so far at less than the tolerance.
class Cone {
 public:
  explicit Cone(const glm::dvec2& tip) : tip_(tip) {}

  [[nodiscard]] bool holds(const glm::dvec2& p) const {
    const glm::dvec2 d = p - tip_;
    return is_open_ || (cross(right_, d) >= 0 && cross(d, left_) >= 0 && glm::dot(d, d) >= farthest_);
  }
  void narrow(const glm::dvec2& p, double tolerance) {
    const glm::dvec2 d = p - tip_;
    const double length = glm::length(d);
    if (length <= tolerance) return;
    const glm::dvec2 side = glm::dvec2(-d.y, d.x) * (tolerance / length);
    if (is_open_ || cross(right_, d - side) > 0) right_ = d - side;
    if (is_open_ || cross(d + side, left_) > 0) left_ = d + side;
    farthest_ = length * length;  // a line that turns back keeps its corner
    is_open_ = false;
  }

 private:
  glm::dvec2 tip_, left_{0}, right_{0};
  double farthest_ = 0;
  bool is_open_ = true;
};

}  // namespace

std::vector<Chain> chained(const std::vector<LineSegment>& segments) { return Chaining(segments).run(); }

void straighten(Chain& chain, double tolerance) {
  std::vector<glm::dvec2>& points = chain.points;
  if (points.size() < 3) return;
  if (chain.is_closed) {
    begin_at_corner(points);
    points.push_back(points.front());
  }
  std::vector<glm::dvec2> kept = {points.front()};
  Cone cone(kept.back());
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!cone.holds(points[i])) {
      kept.push_back(points[i - 1]);
      cone = Cone(kept.back());
    }
    cone.narrow(points[i], tolerance);
  }
  if (!chain.is_closed) kept.push_back(points.back());
  points = std::move(kept);
  // The chain runs along a line and back again.
  if (chain.is_closed && points.size() == 2) chain.is_closed = false;
}

}  // namespace frontmost::lines_detail
