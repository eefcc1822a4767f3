// SPDX-License-Identifier: Apache-2.0
// The worked examples of the literature, with their known numbers.

#include <gtest/gtest.h>

#include "frontmost/zbuffer.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

/// A parallel view of 8 x 8 pixels, one unit each: pixel (x, y) is at (x + 0.5, 7.5 - y). Depth runs from 0 to 255.
View eight_by_eight() {
  View view;
  view.width = view.height = 8;
  view.world_from_eye = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  view.projection = make_orthographic(0, 8, 0, 8, {0, 255});
  return view;
}

using Table = std::array<std::array<int, 8>, 8>;

Table depth_table(const Visible& visible, int nothing, int (*number)(float depth)) {
  const Buffer<float> depth = depths_of(visible);
  Table table{};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const std::size_t i = visible.index(x, y);
      table[std::size_t(y)][std::size_t(x)] = visible.primitives[i] == no_primitive ? nothing : number(depth[i]);
    }
  return table;
}

// Van Dam's integer z-buffer: near 0, far 255, a triangle at 64 and a second at 127.
TEST(WorkedExample, IntegerDepthTable) {
  Mesh mesh;
  // The triangle covers, in row y, pixels 0 to 6 - y: its long edge passes just under the centres of the diagonal.
  add_triangle(mesh, {0, 8, -64}, {0, 0.6f, -64}, {7.4f, 8, -64});
  // The second triangle, behind at 127, wins pixel 2 in row 5 from the background, and more pixels in rows 6 and 7.
  add_triangle(mesh, {0, 0, -127}, {5.4f, 0, -127}, {0.6f, 4.8f, -127});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const Visible visible = draw_both_ways(surfaces, eight_by_eight());
  const Table expected{{{64, 64, 64, 64, 64, 64, 64, 255},
                        {64, 64, 64, 64, 64, 64, 255, 255},
                        {64, 64, 64, 64, 64, 255, 255, 255},
                        {64, 64, 64, 64, 255, 255, 255, 255},
                        {64, 64, 64, 255, 255, 255, 255, 255},
                        {64, 64, 127, 255, 255, 255, 255, 255},
                        {64, 127, 127, 127, 255, 255, 255, 255},
                        {127, 127, 127, 127, 127, 255, 255, 255}}};
  EXPECT_EQ(depth_table(visible, 255, [](float d) { return int(std::lround(d)); }), expected);
}

// The other direction: background 0, greater is nearer, a triangle of value 5.
TEST(WorkedExample, IntegerDepthTableTheOtherWay) {
  Mesh mesh;
  add_triangle(mesh, {0, 8, -250}, {0, 0.6f, -250}, {7.4f, 8, -250});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const Visible visible = draw_both_ways(surfaces, eight_by_eight());
  const Table table = depth_table(visible, 0, [](float d) { return int(std::lround(255 - d)); });
  for (std::size_t y = 0; y < 8; ++y)
    for (std::size_t x = 0; x < 8; ++x) EXPECT_EQ(table[y][x], x + y < 7 ? 5 : 0) << x << ", " << y;
}

// A point between (-4, 2) and (2, 5), seen straight ahead, lies at depth 4; linear interpolation would give 4.5.
TEST(WorkedExample, DepthIsInterpolatedByItsReciprocal) {
  Mesh mesh;
  add_triangle(mesh, {-4, -1, -2}, {2, -1, -5}, {-4, 1, -2});
  add_triangle(mesh, {2, -1, -5}, {2, 1, -5}, {-4, 1, -2});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View view;
  view.width = view.height = 1001;  // odd, so that a pixel centre is on the axis
  view.world_from_eye = glm::dmat4(1.0);
  view.projection = make_frustum(-0.2, 0.2, -0.2, 0.2, {1, 10});
  const Visible visible = draw_both_ways(surfaces, view);
  EXPECT_NEAR(depths_of(visible)[visible.index(500, 500)], 4.0f, 1e-4f);
}

// Gortler's two segments that cross in the middle of the picture: one at -1, one from -0.1 to -1000000.
TEST(WorkedExample, SegmentsCrossMidScreen) {
  Mesh mesh;
  // Image-plane y runs from -1 (bottom) to 1 (top). The steep segment is nearer below, the level one above.
  add_triangle(mesh, {-1, -1, -1}, {1, -1, -1}, {-1, 1, -1});
  add_triangle(mesh, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1});
  const float near = 0.52631578f, far = 10.0f;  // 1/near + 1/far = 2: crosses 1 in the middle
  add_triangle(mesh, {-near, -near, -near}, {near, -near, -near}, {-far, far, -far});
  add_triangle(mesh, {near, -near, -near}, {far, far, -far}, {-far, far, -far});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View view;
  view.width = 64;
  view.height = 64;
  view.projection = make_frustum(-0.1, 0.1, -0.1, 0.1, {0.1, 2e6});
  const Visible visible = draw_both_ways(surfaces, view);
  for (int y = 0; y < 64; ++y) {
    const PrimitiveId id = visible.primitives[visible.index(31, y)];
    EXPECT_EQ(id >= 2, y >= 32) << "row " << y;
  }
}

TEST(WorkedExample, SegmentFromATenthToAMillion) {
  Mesh mesh;
  add_triangle(mesh, {-1, -1, -1}, {1, -1, -1}, {-1, 1, -1});
  add_triangle(mesh, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1});
  const float n = 0.1f, f = 1e6f;
  add_triangle(mesh, {-n, -n, -n}, {n, -n, -n}, {-f, f, -f});
  add_triangle(mesh, {n, -n, -n}, {f, f, -f}, {-f, f, -f});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View view;
  view.width = view.height = 200;
  view.projection = make_frustum(-0.05, 0.05, -0.05, 0.05, {0.05, 4e6});
  const Visible visible = draw_both_ways(surfaces, view);
  // 1/z falls linearly from 10 to 1e-6 over the picture, so it passes 1 nine tenths of the way up: row 20.
  for (int y = 0; y < 200; ++y) EXPECT_EQ(visible.primitives[visible.index(100, y)] >= 2, y >= 20) << "row " << y;
}

TEST(WorkedExample, RingOfThreeHasNoOrderYetIsRight) {
  // Three bars, each over the next: where two cross, the higher end wins.
  Mesh mesh;
  const double turn = 2.0943951023931953;
  for (int i = 0; i < 3; ++i) {
    const auto at = [&](double along, double across, double height) {
      const double c = std::cos(turn * i), s = std::sin(turn * i);
      return glm::vec3(float(c * along - s * across), float(s * along + c * across), float(height));
    };
    add_triangle(mesh, at(-1, -0.6, -0.2), at(1, -0.6, 0.2), at(1, -0.4, 0.2));
    add_triangle(mesh, at(-1, -0.6, -0.2), at(1, -0.4, 0.2), at(-1, -0.4, -0.2));
  }
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View view{301, 301, 1, look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}), make_orthographic(-1.2, 1.2, -1.2, 1.2, {1, 5}), {}};
  const Visible visible = draw_both_ways(surfaces, view);
  // Bars 0 and 1 cross where the line y = -0.5 meets itself rotated by 120 degrees; the others likewise, rotated.
  int over[3] = {};
  for (int i = 0; i < 3; ++i) {
    const double x = 0.5 / std::tan(turn / 4), y = -0.5;  // bar i's end meets bar i + 1's start
    const double c = std::cos(turn * i), s = std::sin(turn * i);
    const double wx = c * x - s * y, wy = s * x + c * y;
    const PrimitiveId id = visible.primitives[visible.index(int((wx + 1.2) / 2.4 * 301), int((1.2 - wy) / 2.4 * 301))];
    ASSERT_NE(id, no_primitive);
    ++over[id / 2];
  }
  for (const int count : over) EXPECT_EQ(count, 1) << "each bar is on top exactly once";
}

}  // namespace
}  // namespace frontmost::test
