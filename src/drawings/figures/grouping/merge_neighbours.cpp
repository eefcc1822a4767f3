// SPDX-License-Identifier: Apache-2.0
// A shape may be painted at the place of its last polygon if nothing between its polygons in the order covers any of
// them. So only polygons that no later one covers are united, by shared sides, which are found for each colour
// separately in one net.
//
//    order    1  2  3  4  5        2 and 5 share a side and have one colour. If neither 3 nor 4 covers
//    colour   a  b  a  c  b        a part of 2, both can be painted together where 5 is.
#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/parallel.h"
#include "figures/colored_order.h"
#include "figures/grouping/overlaps.h"
#include "figures/side_net.h"
#include "geometry/disjoint_sets.h"
#include "painter/limits.h"

namespace frontmost {
namespace {

using namespace shading;

/// By polygon, whether no later polygon covers a part of it.
std::vector<bool> find_uncovered(const ColoredOrder& order, const Execution& execution) {
  const Overlaps overlaps(order);
  painter_detail::PaintEffort effort(execution, order.polygons.size());
  painter_detail::Poll poll(effort);
  std::vector<bool> uncovered(order.polygons.size());
  for (std::size_t i = 0; i < uncovered.size(); ++i)
    uncovered[i] = !overlaps.any_later(i, [&](std::size_t other) {
      poll.count();
      return overlaps.overlap(i, other);
    });
  return uncovered;
}

std::uint32_t code_of(const glm::u8vec4& c) {
  return std::uint32_t(c.r) << 24 | std::uint32_t(c.g) << 16 | std::uint32_t(c.b) << 8 | c.a;
}

/// By polygon, its shape and whether no later polygon covers a part of it.
struct Polygons {
  std::vector<std::uint32_t> shapes;
  std::vector<bool> uncovered;
};

/// The last polygon of a set is its leader: the set is painted in its place.
using PolygonSets = DisjointSets<std::greater<>>;

/// Joins uncovered polygons of one colour that share a part of a side, and those of one shape.
PolygonSets joined(const ColoredOrder& colored, const Polygons& polygons, const Execution& execution) {
  const auto& [shapes, uncovered] = polygons;
  PolygonSets sets(uncovered.size());
  for (std::uint32_t i = 1; i < uncovered.size(); ++i)
    if (shapes[i] == shapes[i - 1] && uncovered[i] && uncovered[i - 1]) sets.join(i, i - 1);
  std::vector<std::uint32_t> members;
  for (std::uint32_t i = 0; i < uncovered.size(); ++i)
    if (uncovered[i]) members.push_back(i);
  const auto code = [&](std::uint32_t i) { return code_of(colored.shapes[polygons.shapes[i]].color); };
  std::stable_sort(members.begin(), members.end(), [&](auto a, auto b) { return code(a) < code(b); });
  SideNet net;
  for (std::size_t begin = 0, end; begin < members.size(); begin = end) {
    check_cancelled(execution);
    net.clear();
    for (end = begin; end < members.size() && code(members[end]) == code(members[begin]); ++end)
      net.add(colored.corners_of(colored.polygons[members[end]]), members[end]);
    if (end == begin + 1) continue;
    net.weave();
    net.for_each_shared([&](std::uint32_t a, std::uint32_t b) { sets.join(a, b); });
  }
  return sets;
}

}  // namespace

ColoredOrder merge_neighbours(const ColoredOrder& colored, const Execution& execution) {
  const std::size_t count = colored.polygons.size();
  const IeeeScope ieee;
  const Polygons polygons{colored.shapes_of_polygons(), find_uncovered(colored, execution)};
  PolygonSets sets = joined(colored, polygons, execution);
  std::vector<std::uint32_t> places(count), order(count);
  for (std::uint32_t i = 0; i < count; ++i) places[i] = sets.leader_of(i);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return std::tie(places[a], a) < std::tie(places[b], b); });
  const auto are_one = [&](std::uint32_t a, std::uint32_t b) {
    return places[a] == places[b] ||
           (polygons.shapes[a] == polygons.shapes[b] && !polygons.uncovered[a] && !polygons.uncovered[b]);
  };
  ColoredOrder merged;
  merged.view = colored.view;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t i = order[k];
    if (k == 0 || !are_one(order[k - 1], i)) merged.begin_shape(colored.shapes[polygons.shapes[i]].color);
    merged.add_polygon(colored.polygons[i].id, colored.corners_of(colored.polygons[i]));
  }
  return merged;
}

}  // namespace frontmost
