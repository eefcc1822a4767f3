// SPDX-License-Identifier: Apache-2.0
// Polygons are coloured in parts of 256. One thread colours a part into a list of its own, and the lists are joined in
// order. A batch of the shader never holds samples of two parts, so colours do not depend on threads.
//
// A smooth normal only pays if a triangle is visible on at least three square pixels. The visible areas of each
// triangle are summed before anything is coloured, because a triangle may be visible in many parts.
#include <atomic>

#include "base/parallel.h"
#include "base/pool.h"
#include "figures/colored_order.h"
#include "figures/coloring/polygon_colors.h"

namespace frontmost {
namespace {

using namespace shading;

constexpr std::size_t kPolygonsPerPart = 256;
/// Visible area in square pixels; on smaller triangles a smooth normal hardly differs from a flat one.
constexpr float kLarge = 3;

float area_of(const VisibleParts& parts, const PaintPolygon& polygon) {
  const PaintCorner* const corners = parts.corners.data() + polygon.first_corner;
  double twice = 0;
  for (std::size_t i = 2; i < polygon.corner_count; ++i) {
    const glm::dvec3 a = corners[i - 1].at - corners[0].at, b = corners[i].at - corners[0].at;
    twice += a.x * b.y - a.y * b.x;
  }
  return float(std::abs(twice) * 0.5);
}

FigureTriangles triangles_of(const Surfaces& surfaces, const VisibleParts& parts) {
  FigureTriangles triangles{BitSet(surfaces.primitive_count()), BitSet(surfaces.primitive_count())};
  for (const PaintPolygon& polygon : parts.polygons) triangles.seen.add(polygon.id);
  if (!lacks_normals(surfaces.scene())) return triangles;
  std::vector<float> areas(surfaces.primitive_count());
  for (const PaintPolygon& polygon : parts.polygons) areas[polygon.id] += area_of(parts, polygon);
  for (std::size_t id = 0; id < areas.size(); ++id)
    if (areas[id] >= kLarge) triangles.large.add(id);
  return triangles;
}

/// Appends the coloured shapes of consecutive polygons.
void append(const ColoredOrder& part, ColoredOrder& into) {
  const std::size_t polygons = into.polygons.size(), corners = into.corners.size();
  for (const ColoredShape& shape : part.shapes) {
    into.begin_shape(shape.color);
    into.shapes.back().polygon_count = shape.polygon_count;
    into.shapes.back().first_polygon = polygons + shape.first_polygon;
  }
  for (PaintPolygon polygon : part.polygons) {
    polygon.first_corner += corners;
    into.polygons.push_back(polygon);
  }
  into.corners.insert(into.corners.end(), part.corners.begin(), part.corners.end());
}

void reserve(const std::vector<ColoredOrder>& parts, ColoredOrder& into) {
  std::size_t shapes = 0, polygons = 0, corners = 0;
  for (const ColoredOrder& part : parts) {
    shapes += part.shapes.size();
    polygons += part.polygons.size();
    corners += part.corners.size();
  }
  into.shapes.reserve(shapes);
  into.polygons.reserve(polygons);
  into.corners.reserve(corners);
}

}  // namespace

ColoredOrder color_order(PreparedScene& scene, const ShadeInput& input, const VisibleParts& parts,
                         const FigureOptions& options, const Execution& execution) {
  const IeeeScope ieee;
  const Surfaces& surfaces = scene.surfaces;
  const FigureTriangles triangles = triangles_of(surfaces, parts);
  const PointShader shader(scene, input, triangles, options.shade, execution);
  const std::size_t count = parts.polygons.size();
  std::vector<ColoredOrder> lists((count + kPolygonsPerPart - 1) / kPolygonsPerPart);
  Pool<PolygonColors> colorers;
  std::atomic<std::size_t> done{0}, made{0};
  parallel_for(execution, count, kPolygonsPerPart, [&](std::size_t begin, std::size_t end) {
    const auto colorer = colorers.borrow(
        [&] { return std::make_unique<PolygonColors>(surfaces, parts.view, shader, options, execution); });
    ColoredOrder& list = lists[begin / kPolygonsPerPart];
    colorer->color(parts, {parts.polygons.data() + begin, end - begin}, list);
    if ((made += list.polygons.size()) > options.most_polygons) refuse_more_than(options.most_polygons);
    report_progress(execution, "colours", double(done += end - begin) / double(count));
  });
  ColoredOrder colored;
  colored.view = parts.view;
  reserve(lists, colored);
  for (ColoredOrder& list : lists) {
    append(list, colored);
    list = {};
  }
  return colored;
}

}  // namespace frontmost
