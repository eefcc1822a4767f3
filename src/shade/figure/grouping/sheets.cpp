// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "painter/limits.h"
#include "shade/figure/colored_order.h"
#include "shade/figure/grouping/overlaps.h"
#include "shade/figure/grouping/sheet_order.h"
#include "shade/figure/side_net.h"

namespace frontmost {
namespace {

using namespace shading;

/// 128 MB. With more, everything stays as it is.
constexpr std::size_t kMostPairs = std::size_t(1) << 24;

void sort_out(std::vector<NodePair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Which shapes are over which, where that matters: not for opaque ones that are over nothing translucent, nor over
/// anything that is. They go first, in the order that they had. None: there are too many.
std::optional<std::vector<NodePair>> find_over(const ColoredOrder& colored, const Execution& execution) {
  const std::vector<std::uint32_t> shape_of = colored.shapes_of_polygons();
  const Overlaps overlaps(colored);
  painter_detail::Poll poll(execution);
  std::vector<NodePair> over;
  std::vector<std::uint8_t> is_bound;
  for (const ColoredShape& shape : colored.shapes) is_bound.push_back(shape.color.a < 255);
  for (std::size_t i = 0; i < shape_of.size(); ++i) {
    const std::uint32_t node = shape_of[i];
    const bool is_full = overlaps.any_earlier(i, [&](std::size_t other) {
      poll.count();
      const std::uint32_t below = shape_of[other];
      if (below == node || !is_bound[below]) return false;
      if (!over.empty() && over.back() == NodePair(below, node)) return false;
      if (!overlaps.overlap(i, other)) return false;
      is_bound[node] = 1;
      over.emplace_back(below, node);
      return over.size() > kMostPairs;
    });
    if (is_full) return std::nullopt;
  }
  sort_out(over);
  return over;
}

/// Translucent neighbours of one opacity.
std::vector<NodePair> find_beside(const ColoredOrder& colored, const Execution& execution) {
  std::vector<NodePair> beside;
  std::array<std::vector<std::uint32_t>, 255> by_opacity;
  for (std::uint32_t i = 0; i < colored.shapes.size(); ++i)
    if (colored.shapes[i].color.a < 255) by_opacity[colored.shapes[i].color.a].push_back(i);
  SideNet net;
  for (const std::vector<std::uint32_t>& members : by_opacity) {
    check_cancelled(execution);
    if (members.size() < 2) continue;
    net.clear();
    for (const std::uint32_t i : members)
      for (const PaintPolygon& polygon : colored.polygons_of(colored.shapes[i]))
        net.add(colored.corners_of(polygon), i);
    net.weave();
    net.for_each_shared([&](std::uint32_t a, std::uint32_t b) {
      if (a != b) beside.insert(beside.end(), {{a, b}, {b, a}});
    });
  }
  sort_out(beside);
  return beside;
}

ColoredOrder in_order(const ColoredOrder& colored, const SheetOrder& order) {
  ColoredOrder made;
  made.view = colored.view;
  for (std::size_t k = 0; k < order.nodes.size(); ++k) {
    const ColoredShape& shape = colored.shapes[order.nodes[k]];
    made.begin_shape(shape.color);
    made.shapes.back().sheet = order.sheets[k];
    for (const PaintPolygon& polygon : colored.polygons_of(shape))
      made.add_polygon(polygon.id, colored.corners_of(polygon));
  }
  return made;
}

}  // namespace

ColoredOrder gather_sheets(ColoredOrder colored, const Execution& execution) {
  const auto is_translucent = [](const ColoredShape& shape) { return shape.color.a < 255; };
  if (std::none_of(colored.shapes.begin(), colored.shapes.end(), is_translucent)) return colored;
  const IeeeScope ieee;
  SheetNodes nodes;
  for (const ColoredShape& shape : colored.shapes) nodes.opacities.push_back(shape.color.a);
  std::optional<std::vector<NodePair>> over = find_over(colored, execution);
  if (!over) return colored;
  nodes.over = std::move(*over);
  nodes.beside = find_beside(colored, execution);
  return in_order(colored, order_in_sheets(nodes));
}

}  // namespace frontmost
