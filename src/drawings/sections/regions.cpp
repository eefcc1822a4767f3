// SPDX-License-Identifier: Apache-2.0
//        +-----------+          Lines are nested, and each line has a winding number on its left and on its right.
//        |  +-----+  |          It bounds a region if one side is filled and the other is not: as the outer line
//        |  | (o) |  |          of a region, or as a hole in the smallest region around it.
//        |  +-----+  |
//        +-----------+
//
// Areas are summed about a point of the line. An area within the rounding error of that sum counts as 0, unless the
// line crosses itself, like an hourglass: then it is filled all the same.
#include "sections/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/orientation.h"
#include "base/parallel.h"

namespace frontmost::lines_detail {
namespace {

constexpr double area_rounding = 1e-12;  // of the sum of absolute terms
constexpr double crossed_area = 1e-6;    // likewise, for lines that turn as much one way as the other

/// A closed line with its properties.
struct Ring {
  SectionOutline points;
  double area = 0;  ///< negative if clockwise
  glm::vec2 low{0}, high{0};
};

Ring ring_of(SectionOutline points) {
  Ring ring;
  ring.low = ring.high = points[0];
  double size = 0, turned = 0;
  const glm::dvec2 origin(points[0]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 a = glm::dvec2(points[i]) - origin;
    const glm::dvec2 b = glm::dvec2(points[i + 1 < points.size() ? i + 1 : 0]) - origin;
    ring.area += (a.x * b.y - a.y * b.x) / 2;
    turned += std::abs(a.x * b.y - a.y * b.x);
    size += std::abs(a.x * b.y) + std::abs(a.y * b.x);
    ring.low = glm::min(ring.low, points[i]);
    ring.high = glm::max(ring.high, points[i]);
  }
  if (std::abs(ring.area) <= area_rounding * size)
    ring.area = turned > crossed_area * size ? std::numeric_limits<double>::min() : 0;
  ring.points = std::move(points);
  return ring;
}

enum class RegionPlace : std::uint8_t { outside, on, inside };

RegionPlace place_in(const SectionOutline& ring, const glm::vec2& p) {
  bool is_inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::vec2 &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
    if (a == p) return RegionPlace::on;
    if (a.y == p.y && b.y == p.y && (a.x > p.x) != (b.x > p.x)) return RegionPlace::on;
    if ((a.y > p.y) == (b.y > p.y)) continue;
    const int side = orientation(a, b, p);
    if (side == 0) return RegionPlace::on;
    if ((side > 0) == (b.y > a.y)) is_inside = !is_inside;
  }
  return is_inside ? RegionPlace::inside : RegionPlace::outside;
}

/// Precondition: the rings do not cross.
bool lies_in(const Ring& inner, const Ring& outer) {
  const bool may = inner.low.x >= outer.low.x && inner.low.y >= outer.low.y && inner.high.x <= outer.high.x &&
                   inner.high.y <= outer.high.y;
  if (!may) return false;
  for (const glm::vec2& p : inner.points)
    if (const RegionPlace place = place_in(outer.points, p); place != RegionPlace::on)
      return place == RegionPlace::inside;
  return std::abs(inner.area) < std::abs(outer.area);
}

/// By ring: the rings that contain it.
std::vector<std::vector<std::uint32_t>> rings_around(const std::vector<Ring>& rings, const Execution& execution) {
  std::vector<std::vector<std::uint32_t>> around(rings.size());
  for (std::uint32_t i = 0; i < rings.size(); ++i) {
    check_cancelled(execution);
    for (std::uint32_t k = 0; k < rings.size(); ++k)
      if (k != i && lies_in(rings[i], rings[k])) around[i].push_back(k);
  }
  return around;
}

/// -1: a hole begins within the ring; 1: a filled region; 0: neither.
int boundary_of(const std::vector<Ring>& rings, const std::vector<std::uint32_t>& around, std::uint32_t ring,
                bool by_winding) {
  const auto turn = [&](std::uint32_t k) { return rings[k].area > 0 ? 1 : -1; };
  int winding = 0;
  for (const std::uint32_t k : around) winding += turn(k);
  const int within = winding + turn(ring);
  const auto is_filled = [&](int number) { return by_winding ? number != 0 : number % 2 != 0; };
  return int(is_filled(within)) - int(is_filled(winding));
}

}  // namespace

std::vector<Region> regions_of(Outlines outlines, const Execution& execution) {
  std::vector<Ring> rings;
  for (SectionOutline& outline : outlines.closed)
    if (Ring ring = ring_of(std::move(outline)); ring.area != 0) rings.push_back(std::move(ring));
  const std::vector<std::vector<std::uint32_t>> around = rings_around(rings, execution);
  std::vector<int> boundary;
  for (std::uint32_t i = 0; i < rings.size(); ++i)
    boundary.push_back(boundary_of(rings, around[i], i, outlines.is_wound_alike));
  std::vector<Region> regions;
  std::vector<std::size_t> region_of(rings.size());
  for (std::uint32_t i = 0; i < rings.size(); ++i) {
    if (boundary[i] == 0) continue;
    if ((rings[i].area > 0) != (boundary[i] > 0)) std::reverse(rings[i].points.begin(), rings[i].points.end());
    if (boundary[i] < 0) continue;
    region_of[i] = regions.size();
    regions.push_back({rings[i].points, {}, std::abs(rings[i].area)});
  }
  for (std::uint32_t i = 0; i < rings.size(); ++i) {
    if (boundary[i] >= 0) continue;
    std::uint32_t nearest = no_index;
    for (const std::uint32_t k : around[i])
      if (boundary[k] > 0 && (nearest == no_index || std::abs(rings[k].area) < std::abs(rings[nearest].area)))
        nearest = k;
    if (nearest == no_index) continue;
    Region& region = regions[region_of[nearest]];
    region.area -= std::abs(rings[i].area);
    region.holes.push_back(std::move(rings[i].points));
  }
  return regions;
}

}  // namespace frontmost::lines_detail
