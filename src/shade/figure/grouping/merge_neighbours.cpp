// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "painter/poll.h"
#include "shade/figure/check_figure.h"
#include "shade/figure/colored_order.h"
#include "shade/figure/grouping/overlaps.h"
#include "shade/figure/grouping/sets.h"
#include "shade/figure/side_net.h"

namespace frontmost {
namespace {

using namespace shading;

/// For every polygon, whether none that is painted later covers a part of it.
std::vector<bool> find_uncovered(const PaintOrder& order, const Execution& execution) {
  const Overlaps overlaps(order);
  painter_detail::Poll poll(execution);
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
  check_figure(colored);
  const std::size_t count = colored.order.polygons.size();
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
    append(colored.order, i, merged.order);
    merged.colors.push_back(colored.colors[i]);
    merged.shapes.push_back(shape);
  }
  return merged;
}

}  // namespace frontmost
