// SPDX-License-Identifier: Apache-2.0
#include <atomic>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "base/pool.h"
#include "shade/figure/colored_order.h"
#include "shade/figure/coloring/polygon_colors.h"

namespace frontmost {
namespace {

using namespace shading;

constexpr std::size_t kPolygonsPerPart = 256;
/// Square pixels in which a triangle is seen: on smaller ones a smooth normal could hardly be told from a flat one.
constexpr float kLarge = 3;

void check(const Surfaces& surfaces, const Visible& visible, const PaintOrder& order, const ColorOptions& options) {
  const auto refuse = [](const char* why) { throw Error(ErrorCode::bad_argument, std::string("figure: ") + why); };
  validate(order.view);
  if (visible.view.width != order.view.width || visible.view.height != order.view.height)
    refuse("what is visible is not of the order's view");
  if (!(options.tolerance >= 0 && options.tolerance <= 255)) refuse("tolerance: must be 0 to 255");
  for (const PaintPolygon& polygon : order.polygons)
    if (polygon.id >= surfaces.primitive_count() || polygon.corner_count < 3 ||
        polygon.corner_count > order.corners.size() ||
        polygon.first_corner > order.corners.size() - polygon.corner_count)
      refuse("the order is not of these surfaces");
}

/// Next to the eye polygons are millions of pixels wide, and all of them would be looked at.
bool reaches_beyond_picture(const PaintOrder& order) {
  const glm::dvec2 size(order.view.width, order.view.height);
  return std::any_of(order.corners.begin(), order.corners.end(), [&](const PaintCorner& corner) {
    return !(corner.at.x > -1 && corner.at.y > -1 && corner.at.x < size.x + 1 && corner.at.y < size.y + 1);
  });
}

float area_of(const PaintOrder& order, const PaintPolygon& polygon) {
  const PaintCorner* const corners = order.corners.data() + polygon.first_corner;
  double twice = 0;
  for (std::size_t i = 2; i < polygon.corner_count; ++i) {
    const glm::dvec3 a = corners[i - 1].at - corners[0].at, b = corners[i].at - corners[0].at;
    twice += a.x * b.y - a.y * b.x;
  }
  return float(std::abs(twice) * 0.5);
}

FigureTriangles triangles_of(const Surfaces& surfaces, const PaintOrder& order) {
  FigureTriangles triangles{BitSet(surfaces.primitive_count()), BitSet(surfaces.primitive_count())};
  for (const PaintPolygon& polygon : order.polygons) triangles.seen.add(polygon.id);
  if (!lacks_normals(surfaces.scene())) return triangles;
  std::vector<float> areas(surfaces.primitive_count());
  for (const PaintPolygon& polygon : order.polygons) areas[polygon.id] += area_of(order, polygon);
  for (std::size_t id = 0; id < areas.size(); ++id)
    if (areas[id] >= kLarge) triangles.large.add(id);
  return triangles;
}

/// Appends what became of consecutive polygons.
void append(const PaintOrder& order, PaintOrder& into) {
  const std::size_t corners = into.corners.size();
  for (PaintPolygon polygon : order.polygons) {
    polygon.first_corner += corners;
    into.polygons.push_back(polygon);
  }
  into.corners.insert(into.corners.end(), order.corners.begin(), order.corners.end());
}

void append(const ColoredOrder& part, ColoredOrder& into) {
  const std::uint32_t shape = into.shapes.empty() ? 0 : into.shapes.back() + 1;
  for (const std::uint32_t number : part.shapes) into.shapes.push_back(shape + number);
  into.colors.insert(into.colors.end(), part.colors.begin(), part.colors.end());
  append(part.order, into.order);
}

void reserve(const std::vector<ColoredOrder>& parts, ColoredOrder& into) {
  std::size_t pieces = 0, corners = 0;
  for (const ColoredOrder& part : parts) {
    pieces += part.colors.size();
    corners += part.order.corners.size();
  }
  into.colors.reserve(pieces);
  into.shapes.reserve(pieces);
  into.order.polygons.reserve(pieces);
  into.order.corners.reserve(corners);
}

/// Of an order within the picture.
ColoredOrder color_within(const Surfaces& surfaces, const Visible& visible, const PaintOrder& order,
                          const ColorOptions& options, const Execution& execution) {
  const IeeeScope ieee;
  const FigureTriangles triangles = triangles_of(surfaces, order);
  const PointShader shader(surfaces, visible, triangles, options.shade, execution);
  const std::size_t count = order.polygons.size();
  std::vector<ColoredOrder> parts((count + kPolygonsPerPart - 1) / kPolygonsPerPart);
  Pool<PolygonColors> colorers;
  std::atomic<std::size_t> done{0}, made{0};
  parallel_for(execution, count, kPolygonsPerPart, [&](std::size_t begin, std::size_t end) {
    const auto colorer = colorers.borrow(
        [&] { return std::make_unique<PolygonColors>(surfaces, order.view, shader, options, execution); });
    ColoredOrder& part = parts[begin / kPolygonsPerPart];
    colorer->color(order, {order.polygons.data() + begin, end - begin}, part);
    if ((made += part.colors.size()) > options.most_polygons) refuse_more_than(options.most_polygons);
    report_progress(execution, "colours", double(done += end - begin) / double(count));
  });
  ColoredOrder colored;
  colored.order.view = order.view;
  colored.order.steps = order.steps;
  reserve(parts, colored);
  for (ColoredOrder& part : parts) {
    append(part, colored);
    part = {};
  }
  return colored;
}

}  // namespace

ColoredOrder color_order(const Surfaces& surfaces, const Visible& visible, const PaintOrder& order,
                         const ColorOptions& options, const Execution& execution) {
  check(surfaces, visible, order, options);
  if (reaches_beyond_picture(order)) {
    const auto hides_nothing = [](PrimitiveId) { return false; };
    return color_within(surfaces, visible, visible_parts(order, hides_nothing, execution), options, execution);
  }
  return color_within(surfaces, visible, order, options, execution);
}

}  // namespace frontmost
