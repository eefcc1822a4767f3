// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "shade/figure/check_figure.h"
#include "shade/figure/colored_order.h"
#include "shade/figure/figure_traps.h"
#include "shade/figure/side_net.h"

namespace frontmost {
namespace {

using namespace shading;

class Outliner {
 public:
  Outliner(Figure& figure, FigureTraps& hems) : figure_(figure), hems_(hems) {}

  void begin_shape(const glm::u8vec4& color, bool is_beside_last) {
    const std::uint32_t sheet = figure_.shapes.empty() ? 0 : figure_.shapes.back().sheet + !is_beside_last;
    figure_.shapes.push_back({color, 0, figure_.rings.size(), sheet});
  }
  void add_ring(std::span<const NetCorner> sides) {
    figure_.rings.push_back({figure_.corners.size(), 0});
    ++figure_.shapes.back().ring_count;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      add(sides[i].at);
      if (sides[i].hem != no_hem) add_hem(sides[i], sides[i + 1 == sides.size() ? 0 : i + 1].at);
    }
  }

 private:
  void add(const glm::dvec2& corner) {
    figure_.corners.push_back(corner);
    ++figure_.rings.back().corner_count;
  }
  /// Around a corner two hems come from the same place: the corner is within them.
  void add_hem(const NetCorner& from, const glm::dvec2& to) {
    std::span<const glm::dvec2> hem = hems_.part(from.hem, from.at, to);
    std::vector<glm::dvec2>& corners = figure_.corners;
    if (!hem.empty() && figure_.rings.back().corner_count > 1 && corners[corners.size() - 2] == hem[0]) {
      corners.pop_back();
      --figure_.rings.back().corner_count;
      hem = hem.subspan(1);
    }
    for (const glm::dvec2& corner : hem) add(corner);
  }

  Figure& figure_;
  FigureTraps& hems_;
};

/// Whether consecutive polygons are in one translucent sheet.
bool are_in_sheet(const ColoredOrder& colored, std::size_t first, std::size_t second) {
  return !colored.sheets.empty() && colored.colors[first].a < 255 && colored.sheets[first] == colored.sheets[second];
}

}  // namespace

Figure outlined(const ColoredOrder& colored, double hem, const std::function<bool(PrimitiveId)>& hides,
                const Execution& execution) {
  check_figure(colored);
  FigureTraps hems(colored, hem, hides, execution);
  const IeeeScope ieee;
  const std::size_t count = colored.colors.size();
  Figure figure;
  figure.view = colored.order.view;
  figure.shapes.reserve(count);
  figure.rings.reserve(count);
  figure.corners.reserve(colored.order.corners.size() * 2);  // about what hems add
  Outliner outliner(figure, hems);
  SideNet net;
  for (std::size_t begin = 0, end; begin < count; begin = end) {
    for (end = begin + 1; end < count && colored.shapes[end] == colored.shapes[begin];) ++end;
    check_cancelled(execution);
    outliner.begin_shape(colored.colors[begin], begin > 0 && are_in_sheet(colored, begin - 1, begin));
    if (end == begin + 1) {
      outliner.add_ring(hems.sides(begin));
      continue;
    }
    net.clear();
    for (std::size_t i = begin; i < end; ++i) {
      net.add(hems.sides(i), std::uint32_t(i));
    }
    net.weave();
    net.for_each_ring([&](std::span<const NetCorner> ring) { outliner.add_ring(ring); });
  }
  return figure;
}

}  // namespace frontmost
