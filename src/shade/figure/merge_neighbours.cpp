// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "frontmost/figure.h"
#include "painter/order/piece_grid.h"
#include "painter/poll.h"
#include "shade/figure/side_net.h"

namespace frontmost {
namespace {

using namespace shading;
using painter_detail::Extent;
using painter_detail::PieceGrid;

/// Pixels by which polygons must overlap to cover each other: those that were cut at each other's sides do so by a
/// rounding.
constexpr double kThin = 1.0 / 512;

using Corners = std::span<const PaintCorner>;

Corners corners_of(const PaintOrder& order, std::size_t i) {
  return {order.corners.data() + order.polygons[i].first_corner, order.polygons[i].corner_count};
}

/// Whether a side of `a` has all of `b` on its outside. Both are counter-clockwise as they are seen, y is down.
bool has_side_between(Corners a, Corners b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec2 from(a[i].at), way = glm::dvec2(a[i + 1 == a.size() ? 0 : i + 1].at) - from;
    const double length = glm::length(way);
    if (!(length > kThin)) continue;
    const auto is_outside = [&](const PaintCorner& corner) {
      const glm::dvec2 p = glm::dvec2(corner.at) - from;
      return way.x * p.y - way.y * p.x > -kThin * length;
    };
    if (std::all_of(b.begin(), b.end(), is_outside)) return true;
  }
  return false;
}

/// For every polygon, whether none that is painted later covers a part of it.
std::vector<bool> find_uncovered(const PaintOrder& order, const Execution& execution) {
  std::vector<Extent> extents;
  for (std::size_t i = 0; i < order.polygons.size(); ++i) {
    Extent extent{glm::vec2(std::numeric_limits<float>::infinity()), glm::vec2(-std::numeric_limits<float>::infinity()),
                  0, 0};
    for (const PaintCorner& corner : corners_of(order, i)) {
      extent.low = glm::min(extent.low, glm::vec2(corner.at));
      extent.high = glm::max(extent.high, glm::vec2(corner.at));
    }
    extents.push_back(extent);
  }
  const PieceGrid grid(extents);
  painter_detail::Poll poll(execution);
  const auto is_covered_in = [&](std::size_t cell, std::size_t i) {
    const std::span<const std::uint32_t> entries = grid.cell(cell);
    for (std::size_t k = entries.size(); k-- > 0 && entries[k] > i;) {
      poll.count();
      const Extent &a = extents[i], &b = extents[entries[k]];
      if (a.low.x >= b.high.x || b.low.x >= a.high.x || a.low.y >= b.high.y || b.low.y >= a.high.y) continue;
      const Corners own = corners_of(order, i), other = corners_of(order, entries[k]);
      if (!has_side_between(own, other) && !has_side_between(other, own)) return true;
    }
    return false;
  };
  std::vector<bool> uncovered(extents.size(), true);
  for (std::size_t i = 0; i < extents.size(); ++i) {
    const PieceGrid::Range cells = grid.range(extents[i]);
    for (int y = cells.first_y; y <= cells.last_y && uncovered[i]; ++y)
      for (int x = cells.first_x; x <= cells.last_x && uncovered[i]; ++x)
        if (is_covered_in(grid.number(x, y), i)) uncovered[i] = false;
  }
  return uncovered;
}

/// Sets of numbers; each is known by its greatest.
class Sets {
 public:
  explicit Sets(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    above_[std::min(a, b)] = std::max(a, b);
  }

 private:
  std::vector<std::uint32_t> above_;
};

std::uint32_t code_of(const glm::u8vec4& c) {
  return std::uint32_t(c.r) << 24 | std::uint32_t(c.g) << 16 | std::uint32_t(c.b) << 8 | c.a;
}

/// Unites uncovered polygons of one colour that share a part of a side, and those of one shape.
Sets united(const ColoredOrder& colored, const std::vector<bool>& uncovered, const Execution& execution) {
  Sets sets(uncovered.size());
  for (std::uint32_t i = 1; i < uncovered.size(); ++i)
    if (colored.shapes[i] == colored.shapes[i - 1] && uncovered[i] && uncovered[i - 1]) sets.unite(i, i - 1);
  std::vector<std::uint32_t> members;
  for (std::uint32_t i = 0; i < uncovered.size(); ++i)
    if (uncovered[i]) members.push_back(i);
  const auto code = [&](std::uint32_t i) { return code_of(colored.colors[i]); };
  std::stable_sort(members.begin(), members.end(), [&](auto a, auto b) { return code(a) < code(b); });
  SideNet net;
  std::vector<NetCorner> corners;
  for (std::size_t begin = 0, end; begin < members.size(); begin = end) {
    check_cancelled(execution);
    net.clear();
    for (end = begin; end < members.size() && code(members[end]) == code(members[begin]); ++end) {
      corners.clear();
      for (const PaintCorner& corner : corners_of(colored.order, members[end]))
        corners.push_back({glm::dvec2(corner.at), {}});
      net.add(corners, members[end]);
    }
    if (end == begin + 1) continue;
    net.weave();
    net.for_each_shared([&](std::uint32_t a, std::uint32_t b) { sets.unite(a, b); });
  }
  return sets;
}

}  // namespace

ColoredOrder merge_neighbours(const ColoredOrder& colored, const Execution& execution) {
  const std::size_t count = colored.order.polygons.size();
  if (colored.colors.size() != count || colored.shapes.size() != count)
    throw Error(ErrorCode::bad_argument, "figure: colours, shapes and polygons differ in number");
  const IeeeScope ieee;
  const std::vector<bool> uncovered = find_uncovered(colored.order, execution);
  Sets sets = united(colored, uncovered, execution);
  std::vector<std::uint32_t> places(count), order(count);
  for (std::uint32_t i = 0; i < count; ++i) places[i] = sets.find(i);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return std::tie(places[a], a) < std::tie(places[b], b); });
  ColoredOrder merged;
  merged.order.view = colored.order.view;
  merged.order.steps = colored.order.steps;
  std::uint32_t shape = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t i = order[k];
    if (k > 0) {
      const std::uint32_t before = order[k - 1];
      const bool was_one = colored.shapes[before] == colored.shapes[i] && !uncovered[before] && !uncovered[i];
      shape += places[before] != places[i] && !was_one;
    }
    PaintPolygon polygon = colored.order.polygons[i];
    const Corners corners = corners_of(colored.order, i);
    polygon.first_corner = merged.order.corners.size();
    merged.order.corners.insert(merged.order.corners.end(), corners.begin(), corners.end());
    merged.order.polygons.push_back(polygon);
    merged.colors.push_back(colored.colors[i]);
    merged.shapes.push_back(shape);
  }
  return merged;
}

}  // namespace frontmost
