// SPDX-License-Identifier: Apache-2.0
// Figures of small scenes with known colours.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/srgb.h"
#include "figures/colored_order.h"
#include "frontmost/zbuffer.h"
#include "shade/figure_support.h"

namespace frontmost {
namespace {

using namespace test;

/// Area of the square, at 16 pixels a unit.
constexpr double kSquare = 32 * 32;

/// All parts of an order, visible or hidden.
VisibleParts all_parts(const PaintOrder& order) { return visible_parts(order, Occluders::none()); }
FigureOptions merging() {
  FigureOptions options;
  options.merges_neighbours = true;
  return options;
}
ColoredOrder figure_of(const Scene& scene, const FigureOptions& options, const Execution& execution = {}) {
  const Surfaces surfaces(scene);
  const View view = front_view();
  return color_order(surfaces, zbuffer(surfaces, view), all_parts(painter(surfaces, view)), options, execution);
}
FigureOptions coloring(Shading shading, double tolerance = 6) {
  FigureOptions options = merging();
  options.shade.shading = shading;
  options.tolerance = tolerance;
  return options;
}

double polygon_area(const ColoredOrder& figure, const PaintPolygon& polygon) {
  const std::span<const glm::dvec2> corners = figure.corners_of(polygon);
  double twice = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const glm::dvec2 p = corners[k], q = corners[(k + 1) % corners.size()];
    twice += q.x * p.y - p.x * q.y;
  }
  return twice / 2;
}
/// Areas in square pixels, by the red value.
std::map<int, double> areas_by_red(const ColoredOrder& figure) {
  std::map<int, double> areas;
  for (const ColoredShape& shape : figure.shapes)
    for (const PaintPolygon& polygon : figure.polygons_of(shape)) areas[shape.color.r] += polygon_area(figure, polygon);
  return areas;
}

/// Ids of the polygons that cover a point.
std::vector<PrimitiveId> ids_over(const ColoredOrder& figure, const glm::dvec2& at) {
  std::vector<PrimitiveId> ids;
  for (const PaintPolygon& polygon : figure.polygons) {
    const std::span<const glm::dvec2> corners = figure.corners_of(polygon);
    bool is_within = true;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const glm::dvec2 from = at - corners[k], way = corners[(k + 1) % corners.size()] - corners[k];
      is_within = is_within && way.x * from.y - way.y * from.x <= 0;  // y points down
    }
    if (is_within) ids.push_back(polygon.id);
  }
  return ids;
}

Scene textured_square(Texture texture, Material::Alpha alpha = Material::Alpha::opaque) {
  Material material;
  material.base_color_texture.texture = 0;
  material.alpha = alpha;
  Scene scene = scene_of(square(), material);
  texture.nearest = true;
  scene.textures.push_back(std::move(texture));
  return scene;
}

constexpr glm::u8vec4 kDark(20, 20, 20, 255), kBright(230, 20, 20, 255), kClear(230, 20, 20, 0);

TEST(ColorOrder, HasTheColoursOfThePicture) {
  const Scene scene = scene_of(square(), colored({1, 0.5f, 0, 0.25f}));
  const Surfaces surfaces(scene);
  const View view = front_view();
  const Visible visible = zbuffer(surfaces, view);
  for (const Shading shading : {Shading::lit, Shading::flat, Shading::normals, Shading::ids, Shading::depth}) {
    const Image picture = shade(surfaces, visible, coloring(shading).shade);
    const glm::vec4 pixel = color_at(picture, 32, 30);
    const ColoredOrder figure = figure_of(scene, coloring(shading));
    ASSERT_EQ(figure.polygons.size(), 2u);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(figure.shapes[0].color[k], srgb8_of_linear(pixel[k]), 1) << int(shading) << k;
    EXPECT_EQ(figure.shapes[0].color.a, 255);
  }
}

TEST(ColorOrder, OpacityMultiplies) {
  FigureOptions options = merging();
  options.shade.opacity = 0.5f;
  for (const ColoredShape& shape : figure_of(scene_of(square()), options).shapes) EXPECT_EQ(shape.color.a, 128);
}

TEST(ColorOrder, CutsAlongTheBordersOfTexels) {
  const Scene scene = textured_square(texture_of(2, 2, {kDark, kBright, kBright, kDark}));
  const ColoredOrder figure = figure_of(scene, coloring(Shading::flat));
  const std::map<int, double> areas = areas_by_red(figure);
  // Textures are smoothed over a pixel beside borders, where a colour in between may occur.
  EXPECT_NEAR(areas.at(20), kSquare / 2, 8);
  EXPECT_NEAR(areas.at(230), kSquare / 2, 8);
  EXPECT_LE(figure.polygons.size(), 20u);
}

TEST(ColorOrder, PiecesFillTheirPolygonAndDifferByNoMoreThanTheTolerance) {
  Mesh mesh = square();
  mesh.colors.values = {{0.3, 0.3, 0.3, 1}, {1, 1, 1, 1}, {1, 0.3, 0.3, 1}, {0.3, 0.3, 1, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  std::size_t before = 0;
  for (const double tolerance : {255.0, 40.0, 20.0, 10.0}) {
    const ColoredOrder figure = figure_of(scene, coloring(Shading::flat, tolerance));
    double area = 0;
    for (const PaintPolygon& polygon : figure.polygons) {
      EXPECT_GT(polygon_area(figure, polygon), 0);
      area += polygon_area(figure, polygon);
    }
    EXPECT_NEAR(area, kSquare, 1e-6);
    EXPECT_GT(figure.polygons.size(), before);
    before = figure.polygons.size();
  }
  EXPECT_EQ(figure_of(scene, coloring(Shading::flat, 255)).polygons.size(), 2u);
}

/// Whether a point is inside a shape of one ring, by edge crossings.
bool holds(const Figure& figure, std::size_t shape, const glm::dvec2& at) {
  const FigureRing& ring = figure.rings[figure.shapes[shape].first_ring];
  bool is_within = false;
  for (std::size_t k = 0; k < ring.corner_count; ++k) {
    const glm::dvec2 p = figure.corners[ring.first_corner + k];
    const glm::dvec2 q = figure.corners[ring.first_corner + (k + 1) % ring.corner_count];
    if ((p.y > at.y) != (q.y > at.y) && at.x < p.x + (q.x - p.x) * ((at.y - p.y) / (q.y - p.y))) is_within = !is_within;
  }
  return is_within;
}

/// Pieces with traps look like pieces without: the traps lie under pieces painted later.
TEST(ColorOrder, TrapsOfPiecesAreHidden) {
  Mesh mesh = square();
  mesh.colors.values = {{0.3, 0.3, 0.3, 1}, {1, 1, 1, 1}, {1, 0.3, 0.3, 1}, {0.3, 0.3, 1, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  FigureOptions options = coloring(Shading::flat, 10);
  options.merges_neighbours = false;
  const Figure figure = outlined(figure_of(scene, options), 4);
  double with_traps = 0;
  int painted = 0, far = 0;
  for (std::size_t i = 0; i < figure.shapes.size(); ++i) with_traps += test::area_of(figure, i);
  EXPECT_GT(with_traps, kSquare * 1.3);
  // In slivers beside cuts, narrower than a pixel, colours deviate more from the picture's.
  const Surfaces surfaces(scene);
  const View view = front_view();
  const Image picture = shade(surfaces, zbuffer(surfaces, view), options.shade);
  for (int y = 17; y < 47; ++y)
    for (int x = 17; x < 47; ++x) {
      const glm::dvec2 at(x + 0.51, y + 0.52);
      std::size_t top = figure.shapes.size();
      while (top > 0 && !holds(figure, top - 1, at)) --top;
      ASSERT_GT(top, 0u) << x << ' ' << y;
      ++painted;
      const glm::vec4 pixel = color_at(picture, x, y);
      int furthest = 0;
      for (int k = 0; k < 3; ++k)
        furthest = std::max(furthest, std::abs(int(figure.shapes[top - 1].color[k]) - int(srgb8_of_linear(pixel[k]))));
      far += furthest > 10 + 6;
      ASSERT_LE(furthest, 30) << x << ' ' << y;
    }
  EXPECT_EQ(painted, 900);
  EXPECT_LE(far, 9);
}

/// Bands narrower than a trap: the trap continues under the next ones.
TEST(ColorOrder, TrapsReachUnderMoreThanOnePiece) {
  Mesh mesh = square();
  mesh.colors.values = {{0, 0, 0, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}, {0, 0, 0, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  FigureOptions options = coloring(Shading::flat, 2);
  options.merges_neighbours = false;
  const Figure figure = outlined(figure_of(scene, options), 4);
  EXPECT_GT(figure.shapes.size(), 40u);
  double area = 0;
  for (std::size_t i = 0; i < figure.shapes.size(); ++i) area += test::area_of(figure, i);
  EXPECT_GT(area, kSquare * 3);
}

TEST(ColorOrder, TranslucentPiecesHaveNoTraps) {
  Mesh mesh = square();
  mesh.colors.values = {{0.3, 0.3, 0.3, 1}, {1, 1, 1, 1}, {1, 0.3, 0.3, 1}, {0.3, 0.3, 1, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  FigureOptions options = coloring(Shading::flat, 10);
  options.merges_neighbours = false;
  options.shade.opacity = 0.5f;
  const Figure figure = outlined(figure_of(scene, options), 4);
  double area = 0;
  for (std::size_t i = 0; i < figure.shapes.size(); ++i) area += test::area_of(figure, i);
  EXPECT_NEAR(area, kSquare, 1e-2);
}

TEST(ColorOrder, PolygonsWithoutAreaAreColouredAsWell) {
  const Scene scene = scene_of(square());
  const Surfaces surfaces(scene);
  const View view = front_view();
  VisibleParts parts = all_parts(painter(surfaces, view));
  parts.polygons.resize(1);
  for (std::size_t k = 0; k < 3; ++k) parts.corners[k].at = {20.0 + 5.0 * double(k), 20.0 + 5.0 * double(k), 3};
  const ColoredOrder figure = color_order(surfaces, zbuffer(surfaces, view), parts, merging());
  EXPECT_EQ(figure.polygons.size(), 1u);
}

TEST(ColorOrder, ColoursOfPiecesAreThoseOfThePictureThere) {
  Mesh mesh = square();
  mesh.colors.values = {{0.3, 0.3, 0.3, 1}, {1, 1, 1, 1}, {1, 0.3, 0.3, 1}, {0.3, 0.3, 1, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  const Surfaces surfaces(scene);
  const View view = front_view();
  const Visible visible = zbuffer(surfaces, view);
  const Image picture = shade(surfaces, visible, coloring(Shading::flat).shade);
  const ColoredOrder figure = figure_of(scene, coloring(Shading::flat, 10));
  std::size_t asked = 0;
  for (const ColoredShape& shape : figure.shapes)
    for (const PaintPolygon& polygon : figure.polygons_of(shape)) {
      glm::dvec2 middle(0);
      for (const glm::dvec2& corner : figure.corners_of(polygon)) middle += corner / double(polygon.corner_count);
      const glm::vec4 pixel = color_at(picture, int(middle.x), int(middle.y));
      if (polygon_area(figure, polygon) < 4) continue;
      ++asked;
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(shape.color[k], srgb8_of_linear(pixel[k]), 10 + 6) << polygon.first_corner;
    }
  EXPECT_GT(asked, 20u);
  const std::vector<PrimitiveId> over = ids_over(figure, {20.5, 32.5});
  EXPECT_EQ(over, std::vector<PrimitiveId>{visible.primitives[32 * 64 + 20]});
}

TEST(ColorOrder, LeavesHolesOut) {
  const Scene scene = textured_square(texture_of(4, 1, {kDark, kClear, kBright, kClear}), Material::Alpha::mask);
  const std::map<int, double> areas = areas_by_red(figure_of(scene, coloring(Shading::flat)));
  ASSERT_EQ(areas.size(), 2u);
  EXPECT_NEAR(areas.at(20), kSquare / 4, 0.5);
  EXPECT_NEAR(areas.at(230), kSquare / 4, 0.5);
}

TEST(ColorOrder, ShadowsAreDrawn) {
  Scene scene = scene_of(square());
  scene.instances.push_back({"above", 0, glm::dmat4(0.3)});
  scene.instances[1].world_from_mesh[3] = {0, 0, 0.5, 1};
  for (const Shadows shadows : {Shadows::map, Shadows::rays}) {
    FigureOptions options = merging();
    options.shade.light.shadows = shadows;
    const ColoredOrder lit = figure_of(scene, options);
    options.shade.light.shadows = Shadows::off;
    const ColoredOrder bare = figure_of(scene, options);
    EXPECT_LT(areas_by_red(lit).begin()->first + 30, areas_by_red(bare).begin()->first);
    EXPECT_GT(lit.polygons.size(), bare.polygons.size());
  }
}

/// Cut by the near plane, the ground is a hundred million pixels wide: as many samples would never end.
TEST(ColorOrder, LeavesOutWhatLiesBesideThePicture) {
  Mesh ground;
  ground.positions = {{-900, -1, -900}, {900, -1, -900}, {0, -1, 900}};
  ground.triangles = {{0, 1, 2}};
  const Scene scene = scene_of(ground);
  const Surfaces surfaces(scene);
  View view = front_view();
  view.world_from_eye = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  view.projection = make_projection(1.0, 1.0, {1e-5, 1e5});
  const PaintOrder order = painter(surfaces, view);
  double widest = 0;
  for (const PaintCorner& corner : order.corners) widest = std::max(widest, std::abs(corner.at.x));
  EXPECT_GT(widest, 1e8);
  const ColoredOrder figure = color_order(surfaces, zbuffer(surfaces, view), all_parts(order), coloring(Shading::lit));
  for (const glm::dvec2& corner : figure.corners) {
    EXPECT_LT(std::abs(corner.x - 32), 32.01);
    EXPECT_LT(std::abs(corner.y - 32), 32.01);
  }
  double area = 0;
  for (const PaintPolygon& polygon : figure.polygons) area += polygon_area(figure, polygon);
  EXPECT_NEAR(area, 64 * 32, 5);  // nearly up to the horizon
}

TEST(ColorOrder, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = builtin("gallery");
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 160, 90);
  const Visible visible = zbuffer(surfaces, view);
  const VisibleParts parts = visible_parts(painter(surfaces, view));
  const ColoredOrder one = color_order(surfaces, visible, parts, merging(), {.threads = 1});
  const ColoredOrder three = color_order(surfaces, visible, parts, merging(), {.threads = 3});
  EXPECT_EQ(one.shapes_of_polygons(), three.shapes_of_polygons());
  ASSERT_EQ(one.shapes.size(), three.shapes.size());
  for (std::size_t i = 0; i < one.shapes.size(); ++i) ASSERT_EQ(one.shapes[i].color, three.shapes[i].color);
  EXPECT_EQ(one.corners, three.corners);
}

TEST(ColorOrder, RefusesWhatItCannotBe) {
  const Scene scene = scene_of(square()), nothing = scene_of(Mesh{});
  const Surfaces surfaces(scene), empty(nothing);
  const View view = front_view();
  const Visible visible = zbuffer(surfaces, view);
  const VisibleParts parts = all_parts(painter(surfaces, view));
  FigureOptions options = merging();
  options.shade.opacity = 2;
  EXPECT_THROW((void)color_order(surfaces, visible, parts, options), Error);
  options = merging();
  options.most_polygons = 1;
  EXPECT_THROW((void)color_order(surfaces, visible, parts, options), Error);
  EXPECT_TRUE(color_order(surfaces, visible, all_parts(painter(empty, view)), merging()).polygons.empty());
}

}  // namespace
}  // namespace frontmost
