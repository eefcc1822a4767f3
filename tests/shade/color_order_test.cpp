// SPDX-License-Identifier: Apache-2.0
// Figures of small scenes whose colours are known.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/srgb.h"
#include "frontmost/zbuffer.h"
#include "shade/figure/colored_order.h"
#include "shade/figure_support.h"

namespace frontmost {
namespace {

using namespace test;

/// 16 pixels to the unit.
constexpr double kSquare = 32 * 32;

ColoredOrder figure_of(const Scene& scene, const ColorOptions& options, const Execution& execution = {}) {
  const Surfaces surfaces(scene);
  const View view = front_view();
  return color_order(surfaces, zbuffer(surfaces, view), painter(surfaces, view), options, execution);
}
ColorOptions with(Shading shading, double tolerance = 6) {
  ColorOptions options;
  options.shade.shading = shading;
  options.tolerance = tolerance;
  return options;
}

double area_of(const PaintOrder& order, std::size_t i) {
  const PaintPolygon& polygon = order.polygons[i];
  double twice = 0;
  for (std::size_t k = 0; k < polygon.corner_count; ++k) {
    const glm::dvec3 p = order.corners[polygon.first_corner + k].at;
    const glm::dvec3 q = order.corners[polygon.first_corner + (k + 1) % polygon.corner_count].at;
    twice += q.x * p.y - p.x * q.y;
  }
  return twice / 2;
}
/// Square pixels by red.
std::map<int, double> areas_by_red(const ColoredOrder& figure) {
  std::map<int, double> areas;
  for (std::size_t i = 0; i < figure.colors.size(); ++i) areas[figure.colors[i].r] += area_of(figure.order, i);
  return areas;
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
    const Image picture = shade(surfaces, visible, with(shading).shade);
    const glm::vec4 pixel = color_at(picture, 32, 30);
    const ColoredOrder figure = figure_of(scene, with(shading));
    ASSERT_EQ(figure.colors.size(), 2u);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(figure.colors[0][k], srgb8_of_linear(pixel[k]), 1) << int(shading) << k;
    EXPECT_EQ(figure.colors[0].a, 255);
  }
}

TEST(ColorOrder, OpacityMultiplies) {
  ColorOptions options;
  options.shade.opacity = 0.5f;
  for (const glm::u8vec4& color : figure_of(scene_of(square()), options).colors) EXPECT_EQ(color.a, 128);
}

TEST(ColorOrder, CutsAlongTheBordersOfTexels) {
  const Scene scene = textured_square(texture_of(2, 2, {kDark, kBright, kBright, kDark}));
  const ColoredOrder figure = figure_of(scene, with(Shading::flat));
  const std::map<int, double> areas = areas_by_red(figure);
  // Beside borders textures are smoothed over a pixel: what lies there may have a colour between.
  EXPECT_NEAR(areas.at(20), kSquare / 2, 8);
  EXPECT_NEAR(areas.at(230), kSquare / 2, 8);
  EXPECT_LE(figure.colors.size(), 20u);
}

TEST(ColorOrder, PiecesFillTheirPolygonAndDifferByNoMoreThanTheTolerance) {
  Mesh mesh = square();
  mesh.colors.values = {{0.3, 0.3, 0.3, 1}, {1, 1, 1, 1}, {1, 0.3, 0.3, 1}, {0.3, 0.3, 1, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  std::size_t before = 0;
  for (const double tolerance : {255.0, 40.0, 20.0, 10.0}) {
    const ColoredOrder figure = figure_of(scene, with(Shading::flat, tolerance));
    double area = 0;
    for (std::size_t i = 0; i < figure.colors.size(); ++i) {
      EXPECT_GT(area_of(figure.order, i), 0);
      area += area_of(figure.order, i);
    }
    EXPECT_NEAR(area, kSquare, 1e-6);
    EXPECT_GT(figure.colors.size(), before);
    before = figure.colors.size();
  }
  EXPECT_EQ(figure_of(scene, with(Shading::flat, 255)).colors.size(), 2u);
}

/// Whether a point is within a shape of one ring, by crossings.
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

/// Painted one over the other, pieces with hems look as those without: what is too much lies under later ones.
TEST(ColorOrder, HemsOfPiecesAreHidden) {
  Mesh mesh = square();
  mesh.colors.values = {{0.3, 0.3, 0.3, 1}, {1, 1, 1, 1}, {1, 0.3, 0.3, 1}, {0.3, 0.3, 1, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  ColorOptions options = with(Shading::flat, 10);
  options.groups_pieces = false;
  const Figure figure = outlined(figure_of(scene, options), 4);
  double with_hems = 0;
  int painted = 0, far = 0;
  for (std::size_t i = 0; i < figure.shapes.size(); ++i) with_hems += test::area_of(figure, i);
  EXPECT_GT(with_hems, kSquare * 1.3);
  // Of slivers beside cuts, which are narrower than a pixel, colours are less near to the picture's.
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

/// Bands that are narrower than a hem: it goes on under the next ones.
TEST(ColorOrder, HemsReachUnderMoreThanOnePiece) {
  Mesh mesh = square();
  mesh.colors.values = {{0, 0, 0, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}, {0, 0, 0, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  ColorOptions options = with(Shading::flat, 2);
  options.groups_pieces = false;
  const Figure figure = outlined(figure_of(scene, options), 4);
  EXPECT_GT(figure.shapes.size(), 40u);
  double area = 0;
  for (std::size_t i = 0; i < figure.shapes.size(); ++i) area += test::area_of(figure, i);
  EXPECT_GT(area, kSquare * 3);
}

TEST(ColorOrder, TranslucentPiecesHaveNoHems) {
  Mesh mesh = square();
  mesh.colors.values = {{0.3, 0.3, 0.3, 1}, {1, 1, 1, 1}, {1, 0.3, 0.3, 1}, {0.3, 0.3, 1, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  ColorOptions options = with(Shading::flat, 10);
  options.groups_pieces = false;
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
  PaintOrder order = painter(surfaces, view);
  order.polygons.resize(1);
  for (std::size_t k = 0; k < 3; ++k) order.corners[k].at = {20.0 + 5.0 * double(k), 20.0 + 5.0 * double(k), 3};
  const ColoredOrder figure = color_order(surfaces, zbuffer(surfaces, view), order);
  EXPECT_EQ(figure.colors.size(), 1u);
}

TEST(ColorOrder, ColoursOfPiecesAreThoseOfThePictureThere) {
  Mesh mesh = square();
  mesh.colors.values = {{0.3, 0.3, 0.3, 1}, {1, 1, 1, 1}, {1, 0.3, 0.3, 1}, {0.3, 0.3, 1, 1}};
  const Scene scene = scene_of(mesh, colored({1, 1, 1, 1}));
  const Surfaces surfaces(scene);
  const View view = front_view();
  const Image picture = shade(surfaces, zbuffer(surfaces, view), with(Shading::flat).shade);
  const ColoredOrder figure = figure_of(scene, with(Shading::flat, 10));
  const Visible painted = paint(surfaces, figure.order);
  std::size_t asked = 0;
  for (std::size_t i = 0; i < figure.colors.size(); ++i) {
    glm::dvec2 middle(0);
    const PaintPolygon& polygon = figure.order.polygons[i];
    for (std::size_t k = 0; k < polygon.corner_count; ++k)
      middle += glm::dvec2(figure.order.corners[polygon.first_corner + k].at) / double(polygon.corner_count);
    const glm::vec4 pixel = color_at(picture, int(middle.x), int(middle.y));
    if (area_of(figure.order, i) < 4) continue;
    ++asked;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(figure.colors[i][k], srgb8_of_linear(pixel[k]), 10 + 6) << i;
  }
  EXPECT_GT(asked, 20u);
  EXPECT_EQ(painted.primitives[32 * 64 + 20], zbuffer(surfaces, view).primitives[32 * 64 + 20]);
}

TEST(ColorOrder, LeavesHolesOut) {
  const Scene scene = textured_square(texture_of(4, 1, {kDark, kClear, kBright, kClear}), Material::Alpha::mask);
  const std::map<int, double> areas = areas_by_red(figure_of(scene, with(Shading::flat)));
  ASSERT_EQ(areas.size(), 2u);
  EXPECT_NEAR(areas.at(20), kSquare / 4, 0.5);
  EXPECT_NEAR(areas.at(230), kSquare / 4, 0.5);
}

TEST(ColorOrder, ShadowsAreDrawn) {
  Scene scene = scene_of(square());
  scene.instances.push_back({"above", 0, glm::dmat4(0.3)});
  scene.instances[1].world_from_mesh[3] = {0, 0, 0.5, 1};
  for (const Shadows shadows : {Shadows::map, Shadows::rays}) {
    ColorOptions options;
    options.shade.shadows = shadows;
    const ColoredOrder lit = figure_of(scene, options);
    options.shade.shadows = Shadows::off;
    const ColoredOrder bare = figure_of(scene, options);
    EXPECT_LT(areas_by_red(lit).begin()->first + 30, areas_by_red(bare).begin()->first);
    EXPECT_GT(lit.colors.size(), bare.colors.size());
  }
}

/// Cut by the near plane it is a hundred million pixels wide: as many samples would never end.
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
  const ColoredOrder figure = color_order(surfaces, zbuffer(surfaces, view), order, with(Shading::lit));
  for (const PaintCorner& corner : figure.order.corners) {
    EXPECT_LT(std::abs(corner.at.x - 32), 32.01);
    EXPECT_LT(std::abs(corner.at.y - 32), 32.01);
  }
  double area = 0;
  for (std::size_t i = 0; i < figure.colors.size(); ++i) area += area_of(figure.order, i);
  EXPECT_NEAR(area, 64 * 32, 5);  // nearly up to the horizon
}

TEST(ColorOrder, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = builtin("gallery");
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 160, 90);
  const Visible visible = zbuffer(surfaces, view);
  const PaintOrder order = visible_parts(painter(surfaces, view));
  const ColoredOrder one = color_order(surfaces, visible, order, {}, {.threads = 1});
  const ColoredOrder three = color_order(surfaces, visible, order, {}, {.threads = 3});
  EXPECT_EQ(one.colors, three.colors);
  EXPECT_EQ(one.shapes, three.shapes);
  ASSERT_EQ(one.order.corners.size(), three.order.corners.size());
  for (std::size_t i = 0; i < one.order.corners.size(); ++i)
    ASSERT_EQ(one.order.corners[i].at, three.order.corners[i].at);
}

TEST(ColorOrder, RefusesWhatItCannotBe) {
  const Scene scene = scene_of(square()), other = scene_of(Mesh{});
  const Surfaces surfaces(scene), empty(other);
  const View view = front_view();
  const Visible visible = zbuffer(surfaces, view);
  const PaintOrder order = painter(surfaces, view);
  const auto refused = [&](const ColorOptions& options) {
    EXPECT_THROW((void)color_order(surfaces, visible, order, options), Error);
  };
  refused(with(Shading::flat, -1));
  refused(with(Shading::flat, std::nan("")));
  ColorOptions options;
  options.shade.opacity = 2;
  refused(options);
  options = {};
  options.most_polygons = 1;
  refused(options);
  EXPECT_THROW((void)color_order(empty, visible, order), Error);
  EXPECT_THROW((void)color_order(surfaces, zbuffer(surfaces, front_view(32)), order), Error);
  EXPECT_TRUE(color_order(surfaces, visible, painter(empty, view)).colors.empty());
}

}  // namespace
}  // namespace frontmost
