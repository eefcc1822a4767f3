// SPDX-License-Identifier: Apache-2.0
// Segments are joined at places that are equal to the bit. Where several continue at a place, the leftmost is taken, so
// that outlines touch but never cross. A line that does not close is joined to another line, or to itself, where their
// ends are near. Closed lines are nested, each with a winding number on either side. A line bounds a region if one side
// is filled and the other is not: as the outer line of a region, or as a hole in the smallest region around it.
#include "sections/regions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/orientation.h"
#include "base/parallel.h"
#include "geometry/buckets.h"

namespace frontmost::lines_detail {
namespace {

constexpr double joined_gap = 1e-5;  // the widest gap that is closed, as a share of the section's size
constexpr std::size_t steps_per_poll = 1 << 14;

/// A segment between two places, by their numbers.
struct Step {
  std::uint32_t from, to;
  friend auto operator<=>(const Step&, const Step&) = default;
};

/// The steps of segments, without duplicates; steps in opposite directions cancel out. Sets `places`.
std::vector<Step> steps_of(const std::vector<CutSegment>& segments, std::vector<glm::vec2>& places) {
  for (const CutSegment& segment : segments) {
    places.push_back(segment.from);
    places.push_back(segment.to);
  }
  std::sort(places.begin(), places.end(), is_left_of);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  const auto number = [&](const glm::vec2& p) {
    return std::uint32_t(std::lower_bound(places.begin(), places.end(), p, is_left_of) - places.begin());
  };
  std::vector<std::pair<Step, int>> ways;  // from the lower place, and whether forwards or backwards
  for (const CutSegment& segment : segments) {
    const std::uint32_t from = number(segment.from), to = number(segment.to);
    if (from != to) ways.push_back({{std::min(from, to), std::max(from, to)}, from < to ? 1 : -1});
  }
  std::sort(ways.begin(), ways.end());
  std::vector<Step> steps;
  for (std::size_t i = 0; i < ways.size();) {
    const Step way = ways[i].first;
    int sum = 0;
    for (; i < ways.size() && ways[i].first == way; ++i) sum += ways[i].second;
    if (sum > 0) steps.push_back(way);
    if (sum < 0) steps.push_back({way.to, way.from});
  }
  return steps;
}

/// The steps at each place; `end` chooses the end of the step that counts.
Buckets<std::uint32_t> steps_at(const std::vector<Step>& steps, std::size_t places, std::uint32_t Step::*end,
                                const Execution& execution) {
  const auto list = [&](std::size_t i, const auto& add) { add(steps[i].*end, std::uint32_t(i)); };
  return {places, steps.size(), list, execution};
}

/// Walks along steps until none is left.
struct Walker {
  void run() {
    // Open lines begin at places with more steps out than in.
    for (std::uint32_t i = 0; i < steps.size(); ++i)
      if (out[steps[i].from].size() > in[steps[i].from].size()) walk(i);
    for (std::uint32_t i = 0; i < steps.size(); ++i) walk(i);
  }

  void walk(std::uint32_t first) {
    if (is_used[first]) return;
    path = {steps[first].from};
    at[path[0]] = 0;
    for (std::uint32_t to = take(first, false); to != no_index; to = next()) {
      if (at[to] == no_index) {
        at[to] = std::uint32_t(path.size());
        path.push_back(to);
        continue;
      }
      const std::size_t begin = at[to];  // the path closes a loop from there
      if (path.size() - begin > 2) closed.push_back(points_from(begin));
      for (std::size_t i = begin + 1; i < path.size(); ++i) at[path[i]] = no_index;
      path.resize(begin + 1);
    }
    if (path.size() > 1) open.push_back(points_from(0));
    for (const std::uint32_t place : path) at[place] = no_index;
  }

  [[nodiscard]] SectionOutline points_from(std::size_t begin) const {
    SectionOutline points;
    for (std::size_t i = begin; i < path.size(); ++i) points.push_back(places[path[i]]);
    return points;
  }

  std::uint32_t take(std::uint32_t step, bool is_turned) {
    if (++taken % steps_per_poll == 0) check_cancelled(execution);
    is_used[step] = 1;
    if (is_turned) is_wound_alike = false;
    return is_turned ? steps[step].from : steps[step].to;
  }

  /// Takes the leftmost unused step from the path's end. \returns the place to which it leads; no_index if there is
  /// none.
  std::uint32_t next() {
    const std::uint32_t end = path.back();
    std::uint32_t best = no_index;
    for (const std::uint32_t step : out[end])
      if (!is_used[step] && (best == no_index || is_before(steps[step].to, steps[best].to))) best = step;
    if (best != no_index) return take(best, false);
    for (const std::uint32_t step : in[end])
      if (!is_used[step]) return take(step, true);
    return no_index;
  }

  /// Whether place a comes before place b, clockwise around the path's end, counted from the direction from which the
  /// path came.
  [[nodiscard]] bool is_before(std::uint32_t a, std::uint32_t b) const {
    if (path.size() < 2) return false;
    const glm::vec2 &from = places[path[path.size() - 2]], &end = places[path.back()];
    const int side_a = orientation(from, end, places[a]), side_b = orientation(from, end, places[b]);
    if (side_a != side_b) return side_a > side_b;
    return orientation(end, places[b], places[a]) > 0;
  }

  const std::vector<glm::vec2>& places;
  const std::vector<Step>& steps;
  const Execution& execution;
  const Buckets<std::uint32_t> out = steps_at(steps, places.size(), &Step::from, execution);
  const Buckets<std::uint32_t> in = steps_at(steps, places.size(), &Step::to, execution);
  std::vector<std::uint8_t> is_used = std::vector<std::uint8_t>(steps.size());
  std::vector<std::uint32_t> path{};
  std::vector<std::uint32_t> at =
      std::vector<std::uint32_t>(places.size(), no_index);  ///< by place: its number in the path
  std::size_t taken = 0;
  std::vector<SectionOutline> closed{}, open{};
  bool is_wound_alike = true;
};

/// For each line, the line that begins nearest to its end, within `gap`. No line succeeds two others.
std::vector<std::uint32_t> successors(const std::vector<SectionOutline>& lines, double gap) {
  std::vector<std::uint32_t> order(lines.size()), next(lines.size(), no_index);
  std::iota(order.begin(), order.end(), 0u);
  const auto start_x = [&](std::uint32_t i) { return lines[i].front().x; };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return start_x(a) < start_x(b); });
  std::vector<std::uint8_t> is_taken(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const glm::dvec2 end = lines[i].back();
    double nearest = gap;
    const auto begin = std::lower_bound(order.begin(), order.end(), end.x - gap,
                                        [&](std::uint32_t k, double x) { return start_x(k) < x; });
    for (auto k = begin; k != order.end() && start_x(*k) <= end.x + gap; ++k) {
      const double off = glm::distance(glm::dvec2(lines[*k].front()), end);
      if (is_taken[*k] || !(off < nearest)) continue;
      nearest = off;
      next[i] = *k;
    }
    if (next[i] != no_index) is_taken[next[i]] = 1;
  }
  return next;
}

constexpr double area_rounding = 1e-12;  // an area is 0 up to this share of the sum of absolute terms
constexpr double crossed_area = 1e-6;    // a line without area counts if it turns by more than this: it crosses itself

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

/// Whether ring `inner` lies in ring `outer`. Precondition: the rings do not cross.
bool lies_in(const Ring& inner, const Ring& outer) {
  const bool may = inner.low.x >= outer.low.x && inner.low.y >= outer.low.y && inner.high.x <= outer.high.x &&
                   inner.high.y <= outer.high.y;
  if (!may) return false;
  for (const glm::vec2& p : inner.points)
    if (const RegionPlace place = place_in(outer.points, p); place != RegionPlace::on)
      return place == RegionPlace::inside;
  return std::abs(inner.area) < std::abs(outer.area);
}

}  // namespace

Outlines find_outlines(const std::vector<CutSegment>& segments, const Execution& execution) {
  std::vector<glm::vec2> places;
  const std::vector<Step> steps = steps_of(segments, places);
  Walker walker{places, steps, execution};
  walker.run();
  Outlines all{std::move(walker.closed), 0, walker.is_wound_alike};
  if (walker.open.empty()) return all;
  glm::dvec2 low(places[0]), high = low;
  for (const glm::vec2& place : places) {
    low = glm::min(low, glm::dvec2(place));
    high = glm::max(high, glm::dvec2(place));
  }
  const std::vector<SectionOutline>& lines = walker.open;
  const std::vector<std::uint32_t> next = successors(lines, joined_gap * glm::distance(low, high));
  std::vector<bool> is_done(lines.size());
  for (std::uint32_t i = 0; i < lines.size(); ++i) {
    SectionOutline line;
    std::uint32_t k = i;
    for (; k != no_index && !is_done[k]; k = next[k]) {
      is_done[k] = true;
      line.insert(line.end(), lines[k].begin(), lines[k].end());
    }
    all.open_count += k == no_index;
    if (k == i && line.size() > 2) all.closed.push_back(std::move(line));
  }
  return all;
}

std::vector<Region> regions_of(Outlines outlines, const Execution& execution) {
  std::vector<Ring> rings;
  for (SectionOutline& outline : outlines.closed)
    if (Ring ring = ring_of(std::move(outline)); ring.area != 0) rings.push_back(std::move(ring));
  std::vector<std::vector<std::uint32_t>> around(rings.size());  // by ring: the rings that contain it
  std::vector<int> boundary;  // -1: a hole begins within the ring; 1: a filled region; 0: neither
  const auto turn = [&](std::uint32_t k) { return rings[k].area > 0 ? 1 : -1; };
  const auto is_filled = [&](int winding) { return outlines.is_wound_alike ? winding != 0 : winding % 2 != 0; };
  for (std::uint32_t i = 0; i < rings.size(); ++i) {
    check_cancelled(execution);
    for (std::uint32_t k = 0; k < rings.size(); ++k)
      if (k != i && lies_in(rings[i], rings[k])) around[i].push_back(k);
    int winding = 0;
    for (const std::uint32_t k : around[i]) winding += turn(k);
    boundary.push_back(int(is_filled(winding + turn(i))) - int(is_filled(winding)));
  }
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
