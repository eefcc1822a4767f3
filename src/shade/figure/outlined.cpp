// SPDX-License-Identifier: Apache-2.0
#include "base/float_environment.h"
#include "base/parallel.h"
#include "frontmost/figure.h"
#include "shade/figure/side_net.h"

namespace frontmost {
namespace {

using namespace shading;

/// Of an inset hem, the part of a side that each of its ends takes at most.
constexpr double kMostInset = 0.45;

using Corners = std::span<const PaintCorner>;

Corners corners_of(const PaintOrder& order, std::size_t i) {
  return {order.corners.data() + order.polygons[i].first_corner, order.polygons[i].corner_count};
}

/// The hem of the side from one corner to another whose first corner beside it is `beside`.
SideHem hem_between(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& beside) {
  const glm::dvec2 way = (to - from) / glm::length(to - from), out = beside - from;
  return {float(std::abs(way.x * out.y - way.y * out.x)), float(glm::dot(way, out))};
}

/// Reads hems off: where a polygon has two corners more between two of its own.
void read_hems(Corners bare, Corners hemmed, std::vector<NetCorner>& corners) {
  corners.clear();
  std::size_t at = 0;
  for (std::size_t i = 0; i < bare.size(); ++i, ++at) {
    const glm::dvec2 from(bare[i].at), to(bare[i + 1 == bare.size() ? 0 : i + 1].at);
    NetCorner corner{from, {}};
    const bool is_last = i + 1 == bare.size();
    const bool is_hemmed = at + 2 < hemmed.size() && (is_last || glm::dvec2(hemmed[at + 1].at) != to);
    if (is_hemmed) {
      corner.hem = hem_between(from, to, glm::dvec2(hemmed[at + 1].at));
      at += 2;
    }
    corners.push_back(corner);
  }
}

class Outliner {
 public:
  explicit Outliner(Figure& figure) : figure_(figure) {}

  void begin_shape(const glm::u8vec4& color) { figure_.shapes.push_back({color, 0, figure_.rings.size()}); }
  void add_ring(Corners corners) {
    begin_ring();
    for (const PaintCorner& corner : corners) add(glm::dvec2(corner.at));
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
  /// A part of a side has the part of its hem that rises as steeply from its ends.
  void add_hem(const NetCorner& from, const glm::dvec2& to) {
    const double length = glm::length(to - from.at);
    const double inset = std::min(double(from.hem.inset), kMostInset * length);
    const double width = from.hem.inset > 0 ? double(from.hem.width) * inset / double(from.hem.inset) : 0;
    const glm::dvec2 along = (to - from.at) / length, out = glm::dvec2(-along.y, along.x) * width;
    add(from.at + along * inset + out);
    add(to - along * inset + out);
  }

  Figure& figure_;
};

/// Hems may reach over other parts of the same primitive, as if it had one colour. That is true of a shape, and of
/// parts of a primitive that have the same; so numbers of such groups take the place of the primitive's.
PaintOrder hemmed_by_color(const ColoredOrder& colored, double hem, const std::function<bool(PrimitiveId)>& hides,
                           const Execution& execution) {
  PaintOrder order = colored.order;
  const std::vector<PaintPolygon>& polygons = colored.order.polygons;
  std::vector<std::uint8_t> hiding;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    const bool goes_on =
        i > 0 && (colored.shapes[i] == colored.shapes[i - 1] ||
                  (polygons[i].id == polygons[i - 1].id && colored.colors[i] == colored.colors[i - 1]));
    if (!goes_on) hiding.push_back(1);
    hiding.back() = hiding.back() && (!hides || hides(polygons[i].id));
    order.polygons[i].id = PrimitiveId(hiding.size() - 1);
  }
  return with_hems(
      order, hem, [&](PrimitiveId shape) { return hiding[shape] != 0; }, execution);
}

}  // namespace

Figure outlined(const ColoredOrder& colored, double hem, const std::function<bool(PrimitiveId)>& hides,
                const Execution& execution) {
  const std::size_t count = colored.order.polygons.size();
  if (colored.colors.size() != count || colored.shapes.size() != count)
    throw Error(ErrorCode::bad_argument, "figure: colours, shapes and polygons differ in number");
  const PaintOrder hemmed = hemmed_by_color(colored, hem, hides, execution);
  const IeeeScope ieee;
  Figure figure;
  figure.view = colored.order.view;
  Outliner outliner(figure);
  SideNet net;
  std::vector<NetCorner> corners;
  for (std::size_t begin = 0, end; begin < count; begin = end) {
    for (end = begin + 1; end < count && colored.shapes[end] == colored.shapes[begin];) ++end;
    check_cancelled(execution);
    outliner.begin_shape(colored.colors[begin]);
    if (end == begin + 1) {
      outliner.add_ring(corners_of(hemmed, begin));
      continue;
    }
    net.clear();
    for (std::size_t i = begin; i < end; ++i) {
      read_hems(corners_of(colored.order, i), corners_of(hemmed, i), corners);
      net.add(corners, std::uint32_t(i));
    }
    net.weave();
    net.for_each_ring([&](std::span<const NetCorner> ring) { outliner.add_ring(ring); });
  }
  return figure;
}

}  // namespace frontmost
