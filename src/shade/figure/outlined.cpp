// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "frontmost/figure.h"
#include "shade/figure/check_figure.h"
#include "shade/figure/side_net.h"
#include "shade/figure/whole_hems.h"

namespace frontmost {
namespace {

using namespace shading;

/// Of an inset hem, the part of a side that each of its ends takes at most.
constexpr double kMostInset = 0.45;

class Outliner {
 public:
  explicit Outliner(Figure& figure) : figure_(figure) {}

  void begin_shape(const glm::u8vec4& color, bool is_beside_last) {
    const std::uint32_t sheet = figure_.shapes.empty() ? 0 : figure_.shapes.back().sheet + !is_beside_last;
    figure_.shapes.push_back({color, 0, figure_.rings.size(), sheet});
  }
  void add_ring(std::span<const HemmedSide> sides) {
    begin_ring();
    for (std::size_t i = 0; i < sides.size(); ++i) {
      add(sides[i].from);
      if (sides[i].hem.width > 0) add_hem(sides[i], sides[i + 1 == sides.size() ? 0 : i + 1].from);
    }
  }
  void add_ring(std::span<const NetCorner> corners) {
    begin_ring();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      add(corners[i].at);
      if (corners[i].hem.width > 0) add_hem(corners[i], corners[i + 1 == corners.size() ? 0 : i + 1].at);
    }
  }

 private:
  void begin_ring() {
    figure_.rings.push_back({figure_.corners.size(), 0});
    ++figure_.shapes.back().ring_count;
  }
  void add(const glm::dvec2& corner) {
    figure_.corners.push_back(corner);
    ++figure_.rings.back().corner_count;
  }
  /// The part of a whole side's hem that lies beside a part of the side.
  void add_hem(const HemmedSide& side, const glm::dvec2& to) {
    const double length = glm::length(to - side.from);
    if (!(length > 0)) return;
    const double width = double(side.hem.width), end = side.begin + length, last = side.whole_length;
    const double inset = double(side.hem.inset), end_inset = double(side.hem.end_inset);
    const glm::dvec2 along = (to - side.from) / length, out(-along.y, along.x);
    const auto height = [&](double s) {
      const double rising = inset > 0 ? s / inset : 1, falling = end_inset > 0 ? (last - s) / end_inset : 1;
      return width * std::clamp(std::min(rising, falling), 0.0, 1.0);
    };
    const auto add_at = [&](double s) { add(side.from + along * (s - side.begin) + out * height(s)); };
    constexpr double kAtEnd = 1e-6;  // pixels
    if (side.begin > kAtEnd) add_at(side.begin);
    for (const double bend : {inset, last - end_inset})
      if (bend > side.begin && bend < end) add_at(bend);
    if (end < last - kAtEnd) add_at(end);
  }
  /// A part of a side has the part of its hem that rises as steeply from its ends.
  void add_hem(const NetCorner& from, const glm::dvec2& to) {
    const double length = glm::length(to - from.at);
    const double most = double(std::max(from.hem.inset, from.hem.end_inset));
    const double inset = std::min(most, kMostInset * length);
    const double width = most > 0 ? double(from.hem.width) * inset / most : 0;
    const glm::dvec2 along = (to - from.at) / length, out = glm::dvec2(-along.y, along.x) * width;
    add(from.at + along * inset + out);
    add(to - along * inset + out);
  }

  Figure& figure_;
};

/// Whether consecutive polygons are in one translucent sheet.
bool are_in_sheet(const ColoredOrder& colored, std::size_t first, std::size_t second) {
  return !colored.sheets.empty() && colored.colors[first].a < 255 && colored.sheets[first] == colored.sheets[second];
}

}  // namespace

Figure outlined(const ColoredOrder& colored, double hem, const std::function<bool(PrimitiveId)>& hides,
                const Execution& execution) {
  check_figure(colored);
  WholeHems hems(colored, hem, hides, execution);
  const IeeeScope ieee;
  const std::size_t count = colored.colors.size();
  Figure figure;
  figure.view = colored.order.view;
  figure.shapes.reserve(count);
  figure.rings.reserve(count);
  figure.corners.reserve(colored.order.corners.size() * 2);  // about what hems add
  Outliner outliner(figure);
  SideNet net;
  std::vector<NetCorner> corners;
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
      corners.clear();
      for (const HemmedSide& side : hems.sides(i)) corners.push_back({side.from, side.hem});
      net.add(corners, std::uint32_t(i));
    }
    net.weave();
    net.for_each_ring([&](std::span<const NetCorner> ring) { outliner.add_ring(ring); });
  }
  return figure;
}

}  // namespace frontmost
