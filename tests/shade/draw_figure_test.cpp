// SPDX-License-Identifier: Apache-2.0
// Figures by one call: only the visible parts, in the picture's colours, and complete.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "frontmost/frontmost.h"
#include "shade/figure_support.h"

namespace frontmost::test {
namespace {

FigureOptions flat() {
  FigureOptions options;
  options.shade.shading = Shading::flat;
  return options;
}

double painted_area(const Figure& figure) {
  double area = 0;
  for (const FigureRing& ring : figure.rings) area += std::abs(area_of(figure, ring));
  return area;
}

TEST(DrawFigure, ShowsWhatIsSeenAlone) {
  const Scene scene = builtin("cubes");
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 200, 150);
  FigureOptions options = flat();
  const Figure seen = draw_figure(surfaces, view, options);
  options.visible_only = false;
  const Figure all = draw_figure(surfaces, view, options);
  const Visible visible = zbuffer(surfaces, view);
  const auto covered = std::count_if(visible.primitives.begin(), visible.primitives.end(),
                                     [](PrimitiveId id) { return id != no_primitive; });
  // Traps under neighbours add 4 pixels along each edge.
  EXPECT_GE(painted_area(seen), 0.99 * double(covered));
  EXPECT_LT(painted_area(seen), 1.35 * double(covered));
  EXPECT_GT(painted_area(all), 1.5 * double(covered));
  EXPECT_EQ(seen.title, scene.name);
  EXPECT_EQ(seen.background, glm::vec3(1));
  EXPECT_EQ(seen.view.width, 200);
}

TEST(DrawFigure, IsTheSameOfAViewAndOfWhatIsVisibleInIt) {
  const Scene scene = builtin("cubes");
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 80, 60);
  const Figure of_visible = draw_figure(surfaces, zbuffer(surfaces, view), flat());
  view.samples = 4;
  const Figure of_view = draw_figure(surfaces, view, flat(), {.threads = 3});
  EXPECT_EQ(of_view.corners, of_visible.corners);
  EXPECT_EQ(of_view.shapes.size(), of_visible.shapes.size());
  EXPECT_GT(of_view.shapes.size(), 15u);
}

TEST(DrawFigure, NeighboursOfOneColourAreOneShape) {
  const Scene scene = builtin("cubes");
  const Surfaces surfaces(scene);
  FigureOptions options = flat();
  const std::size_t apart = draw_figure(surfaces, frame(surfaces, 100, 80), options).shapes.size();
  options.merges_neighbours = true;
  EXPECT_LT(draw_figure(surfaces, frame(surfaces, 100, 80), options).shapes.size(), apart);
}

TEST(DrawFigure, RefusesWhatIsTooManyAndWhatHasMoreSamples) {
  const Scene scene = builtin("cubes");
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 40, 30);
  FigureOptions options = flat();
  options.most_polygons = 3;
  try {
    (void)draw_figure(surfaces, view, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
    EXPECT_THAT(error.what(), testing::EndsWith(" polygons, more than 3"));
  }
  for (const double tolerance : {-1.0, 256.0, std::nan("")}) {
    options = flat();
    options.tolerance = tolerance;
    EXPECT_THROW((void)draw_figure(surfaces, view, options), Error) << tolerance;
  }
  view.samples = 4;
  EXPECT_THROW((void)draw_figure(surfaces, zbuffer(surfaces, view)), Error);
}

TEST(DrawFigure, OfNothingIsEmpty) {
  const Scene scene;
  const Surfaces surfaces(scene);
  EXPECT_TRUE(draw_figure(surfaces, frame(surfaces, 10, 10)).shapes.empty());
}

}  // namespace
}  // namespace frontmost::test
