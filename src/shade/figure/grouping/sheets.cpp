// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "painter/poll.h"
#include "shade/figure/check_figure.h"
#include "shade/figure/colored_order.h"
#include "shade/figure/grouping/overlaps.h"
#include "shade/figure/grouping/sheet_order.h"
#include "shade/figure/side_net.h"

namespace frontmost {
namespace {

using namespace shading;

/// 128 MB. With more, everything stays as it is.
constexpr std::size_t kMostPairs = std::size_t(1) << 24;

/// Consecutive polygons that stay together, as one shape.
struct Nodes {
  std::vector<std::uint32_t> first;  ///< polygons; at the end also how many there are
  std::vector<std::uint32_t> of;     ///< by polygon
  [[nodiscard]] std::size_t count() const { return first.size() - 1; }
};

Nodes find_nodes(const ColoredOrder& colored) {
  Nodes nodes;
  const auto count = std::uint32_t(colored.colors.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i == 0 || colored.shapes[i] != colored.shapes[i - 1]) nodes.first.push_back(i);
    nodes.of.push_back(std::uint32_t(nodes.first.size() - 1));
  }
  nodes.first.push_back(count);
  return nodes;
}

void sort_out(std::vector<NodePair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Who is over whom, where that matters: not for opaque ones that are over nothing translucent, nor over anything that
/// is. They go first, in the order that they had. None: there are too many.
std::optional<std::vector<NodePair>> find_over(const PaintOrder& polygons, const Nodes& nodes,
                                               const std::vector<std::uint8_t>& opacities, const Execution& execution) {
  const Overlaps overlaps(polygons);
  painter_detail::Poll poll(execution);
  std::vector<NodePair> over;
  std::vector<std::uint8_t> is_bound(nodes.count());
  for (std::size_t i = 0; i < is_bound.size(); ++i) is_bound[i] = opacities[i] < 255;
  for (std::size_t i = 0; i < polygons.polygons.size(); ++i) {
    const std::uint32_t node = nodes.of[i];
    const bool is_full = overlaps.any_earlier(i, [&](std::size_t other) {
      poll.count();
      const std::uint32_t below = nodes.of[other];
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
std::vector<NodePair> find_beside(const PaintOrder& polygons, const Nodes& nodes,
                                  const std::vector<std::uint8_t>& opacities, const Execution& execution) {
  std::vector<NodePair> beside;
  std::array<std::vector<std::uint32_t>, 255> by_opacity;
  for (std::uint32_t i = 0; i < polygons.polygons.size(); ++i) {
    const std::uint8_t opacity = opacities[nodes.of[i]];
    if (opacity < 255) by_opacity[opacity].push_back(i);
  }
  SideNet net;
  std::vector<NetCorner> corners;
  for (const std::vector<std::uint32_t>& members : by_opacity) {
    check_cancelled(execution);
    if (members.size() < 2) continue;
    net.clear();
    for (const std::uint32_t i : members) {
      corners.clear();
      for (const PaintCorner& corner : corners_of(polygons, i)) corners.push_back({glm::dvec2(corner.at), {}});
      net.add(corners, nodes.of[i]);
    }
    net.weave();
    net.for_each_shared([&](std::uint32_t a, std::uint32_t b) {
      if (a != b) beside.insert(beside.end(), {{a, b}, {b, a}});
    });
  }
  sort_out(beside);
  return beside;
}

ColoredOrder in_order(const ColoredOrder& colored, const Nodes& nodes, const SheetOrder& order) {
  ColoredOrder made;
  made.order.view = colored.order.view;
  made.order.steps = colored.order.steps;
  std::uint32_t shape = 0;
  for (std::size_t k = 0; k < order.nodes.size(); ++k) {
    const std::uint32_t first = nodes.first[order.nodes[k]], end = nodes.first[order.nodes[k] + 1];
    for (std::uint32_t i = first; i < end; ++i) {
      if (!made.shapes.empty()) shape += i == first || colored.shapes[i] != colored.shapes[i - 1];
      append(colored.order, i, made.order);
      made.colors.push_back(colored.colors[i]);
      made.shapes.push_back(shape);
      made.sheets.push_back(order.sheets[k]);
    }
  }
  return made;
}

}  // namespace

ColoredOrder gather_sheets(ColoredOrder colored, const Execution& execution) {
  check_figure(colored);
  const auto is_translucent = [](const glm::u8vec4& color) { return color.a < 255; };
  if (std::none_of(colored.colors.begin(), colored.colors.end(), is_translucent)) return colored;
  const IeeeScope ieee;
  const Nodes nodes = find_nodes(colored);
  SheetNodes sheet_nodes;
  for (std::size_t i = 0; i < nodes.count(); ++i) sheet_nodes.opacities.push_back(colored.colors[nodes.first[i]].a);
  std::optional<std::vector<NodePair>> over = find_over(colored.order, nodes, sheet_nodes.opacities, execution);
  if (!over) return colored;
  sheet_nodes.over = std::move(*over);
  sheet_nodes.beside = find_beside(colored.order, nodes, sheet_nodes.opacities, execution);
  return in_order(colored, nodes, order_in_sheets(sheet_nodes));
}

}  // namespace frontmost
