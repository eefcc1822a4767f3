// SPDX-License-Identifier: Apache-2.0
// The geometry of the walk over a union: how deep a side runs through an outline, which of the found occluders lies
// over a place, and where a way leaves an occluder. All use the same slack: less than OutlineClipper::thin within an
// outline does not count as within, and less than that beside a side counts as on it. So hairlines between neighbours,
// which rounding leaves, do not open a union.
#include "painter/seen/occluder_union.h"

#include <algorithm>

namespace frontmost::painter_detail {
namespace {

constexpr double kThin = OutlineClipper::thin;

}  // namespace

void CoveredOutline::set(Outline outline) {
  sides_.clear();
  low_ = high_ = glm::dvec2(outline[0].at);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 from(outline[i].at), way = glm::dvec2(outline[i + 1 == outline.size() ? 0 : i + 1].at) - from;
    // Cuts at a corner leave the corner twice, and nothing would be within a side of no length.
    if (const double length = glm::length(way); length >= shortest_side) sides_.push_back({from, way, kThin * length});
    low_ = glm::min(low_, from);
    high_ = glm::max(high_, from);
  }
}

CoveredOutline::Crossing CoveredOutline::crossing(const glm::dvec2& a, const glm::dvec2& b) const {
  constexpr Crossing none{1, 0};
  if (is_beside_box(a, b)) return none;
  Crossing crossing{0, 1};
  const glm::dvec2 way = b - a;
  double least = 0, greatest = 0;
  for (const Side& side : sides_) {
    const double at_a = turn(side.way, a - side.from), at_b = turn(side.way, b - side.from);
    if (at_a >= -side.slack && at_b >= -side.slack) return none;
    if (at_a > 0) crossing.from = std::max(crossing.from, at_a / (at_a - at_b));
    if (at_b > 0) crossing.to = std::min(crossing.to, at_a / (at_a - at_b));
    const double corner = turn(way, side.from - a);
    least = std::min(least, corner);
    greatest = std::max(greatest, corner);
  }
  const double depth = std::min(-least, greatest);
  if (depth * depth <= kThin * kThin * glm::dot(way, way)) return none;
  return crossing;
}

void OccluderUnion::begin(std::uint32_t first) {
  if (++turn_ == 0) {
    std::fill(asked_.begin(), asked_.end(), 0);
    turn_ = 1;
  }
  found_.clear();
  add(first, 0);
}

glm::dvec2 OccluderUnion::beyond(const glm::dvec2& way) {
  return glm::dvec2(-way.y, way.x) * (2 * kThin / glm::length(way));
}

std::uint32_t OccluderUnion::found_at(const glm::dvec2& place, std::size_t likely) const {
  const auto holds = [&](std::size_t i) { return is_within(screen_.outline(found_[i].slot), place, 0); };
  if (holds(likely)) return found_[likely].slot;
  for (std::size_t i = found_.size(); i-- > 0;)
    if (i != likely && holds(i)) return found_[i].slot;
  return no_index;
}

double OccluderUnion::end_within(Outline outline, const glm::dvec2& from, const glm::dvec2& way) {
  double end = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 p(outline[i].at), side = glm::dvec2(outline[i + 1 == outline.size() ? 0 : i + 1].at) - p;
    const double beside = kThin * glm::length(side) - turn(side, from - p), change = turn(side, way);
    if (change > 0) end = std::min(end, beside / change);
  }
  return end;
}

}  // namespace frontmost::painter_detail
