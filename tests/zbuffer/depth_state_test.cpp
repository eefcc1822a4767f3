// SPDX-License-Identifier: Apache-2.0
// The meaning of each piece of state as in OpenGL, with numbers computed by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "frontmost/zbuffer.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

constexpr int kSide = 8;

/// Eight by eight pixels, seen in parallel projection from z = 0 along -z. World (x, y) is a pixel's corner, y up; a
/// point at z = -d has the window depth d.
View flat_view() {
  View view;
  view.width = view.height = kSide;
  view.projection = make_orthographic(0, kSide, 0, kSide, {0, 1});
  return view;
}

/// A rectangle of pixels [x0, x1) x [y0, y1), counted from the top left, at a depth.
void add_rectangle(Mesh& mesh, glm::vec2 low, glm::vec2 high, float depth) {
  const glm::vec3 a(low.x, kSide - high.y, -depth), b(high.x, kSide - high.y, -depth), c(high.x, kSide - low.y, -depth),
      d(low.x, kSide - low.y, -depth);
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
}

Mesh full(float depth) {
  Mesh mesh;
  add_rectangle(mesh, {0, 0}, {kSide, kSide}, depth);
  return mesh;
}

/// Draws meshes one after another, with two ids each.
struct Bench {
  explicit Bench(DepthFormat format = DepthFormat::d24) : buffer(kSide, kSide, 1, format) {}

  void draw(const Mesh& mesh, const DepthState& state = {}) {
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    buffer.draw(surfaces, flat_view(), {.state = state, .id_offset = ids});
    ids += surfaces.primitive_count();
  }
  /// Number of the mesh visible at the first pixel, where each mesh has two triangles; -1: none.
  [[nodiscard]] int seen() const {
    const PrimitiveId id = buffer.visible(flat_view()).primitives[0];
    return id == no_primitive ? -1 : int(id / 2);
  }
  [[nodiscard]] double depth() const { return depth_of_stored(buffer.format(), buffer.stored()[0]); }
  [[nodiscard]] std::string table() const {
    std::string text;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        text += std::to_string(buffer.stored()[std::size_t(y * kSide + x)]) + (x + 1 == kSide ? "\n" : " ");
    return text;
  }

  DepthBuffer buffer;
  PrimitiveId ids = 0;
};

// The lecture's integer z-buffer with near = 0 and far = 255: a triangle at 64, then a polygon at 127 behind it.
TEST(DepthState, IntegerTableOfTheLecture) {
  Mesh triangle;
  add_triangle(triangle, {0, 0.9f, -64 / 255.0f}, {7.1f, 8, -64 / 255.0f}, {0, 8, -64 / 255.0f});
  Mesh polygon;
  add_rectangle(polygon, {0, 5}, {3, 8}, 127 / 255.0f);
  Bench bench(DepthFormat::d8);
  EXPECT_EQ(bench.buffer.stored()[0], 255u);
  bench.draw(triangle);
  EXPECT_EQ(bench.table(),
            "64 64 64 64 64 64 64 255\n64 64 64 64 64 64 255 255\n64 64 64 64 64 255 255 255\n"
            "64 64 64 64 255 255 255 255\n64 64 64 255 255 255 255 255\n64 64 255 255 255 255 255 255\n"
            "64 255 255 255 255 255 255 255\n255 255 255 255 255 255 255 255\n");
  bench.draw(polygon);
  EXPECT_EQ(bench.table(),
            "64 64 64 64 64 64 64 255\n64 64 64 64 64 64 255 255\n64 64 64 64 64 255 255 255\n"
            "64 64 64 64 255 255 255 255\n64 64 64 255 255 255 255 255\n64 64 127 255 255 255 255 255\n"
            "64 127 127 255 255 255 255 255\n127 127 127 255 255 255 255 255\n");
}

// The other table counts the other way: 0 is the background, and greater is nearer.
TEST(DepthState, IntegerTableWithNearerGreater) {
  const DepthState greater{.func = DepthFunc::greater, .nearer_is_greater = true};
  Mesh triangle;
  add_triangle(triangle, {0, 0.9f, 5 / 255.0f - 1}, {7.1f, 8, 5 / 255.0f - 1}, {0, 8, 5 / 255.0f - 1});
  Bench bench(DepthFormat::d8);
  bench.buffer.clear(0);
  bench.draw(triangle, greater);
  EXPECT_EQ(bench.table().substr(0, 32), "5 5 5 5 5 5 5 0\n5 5 5 5 5 5 0 0\n");
  bench.draw(full(1 - 3 / 255.0f), greater);
  EXPECT_EQ(bench.table().substr(0, 32), "5 5 5 5 5 5 5 3\n5 5 5 5 5 5 3 3\n");
}

TEST(DepthState, EveryFunctionComparesAsItsNameSays) {
  struct Row {
    DepthFunc func;
    bool nearer, same, farther;
  };
  for (const Row& row : {Row{DepthFunc::never, false, false, false}, Row{DepthFunc::less, true, false, false},
                         Row{DepthFunc::equal, false, true, false}, Row{DepthFunc::less_equal, true, true, false},
                         Row{DepthFunc::greater, false, false, true}, Row{DepthFunc::not_equal, true, false, true},
                         Row{DepthFunc::greater_equal, false, true, true}, Row{DepthFunc::always, true, true, true}})
    for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24, DepthFormat::f32}) {
      for (const auto& [depth, passes] : {std::pair(0.25f, row.nearer), {0.5f, row.same}, {0.75f, row.farther}}) {
        Bench bench(format);
        bench.draw(full(0.5f));
        bench.draw(full(depth), {.func = row.func});
        EXPECT_EQ(bench.seen(), passes ? 1 : 0) << int(row.func) << " at " << depth;
        EXPECT_NEAR(bench.depth(), passes ? depth : 0.5f, 0.002);
      }
    }
}

TEST(DepthState, TheClearValueIsRoundedAndClamped) {
  Bench d16(DepthFormat::d16), f32(DepthFormat::f32);
  d16.buffer.clear(0.5);
  EXPECT_EQ(d16.buffer.stored()[0], 32768u);  // 32767.5 rounds to the even neighbour
  d16.buffer.clear(7);
  EXPECT_EQ(d16.buffer.stored()[0], 65535u);
  d16.buffer.clear(-7);
  EXPECT_EQ(d16.buffer.stored()[0], 0u);
  f32.buffer.clear(7);
  EXPECT_EQ(f32.depth(), 7);
  // A negative clear value of a float buffer is below every depth.
  f32.buffer.clear(-7);
  f32.draw(full(0), {.func = DepthFunc::less_equal});
  EXPECT_EQ(f32.seen(), -1);
  f32.draw(full(0), {.func = DepthFunc::greater});
  EXPECT_EQ(f32.seen(), 1);
  EXPECT_EQ(f32.depth(), 0);
  f32.buffer.clear(-0.0);
  f32.draw(full(0), {.func = DepthFunc::equal});
  EXPECT_EQ(f32.seen(), 2);
  f32.buffer.clear(1);
  EXPECT_EQ(f32.seen(), -1) << "clearing forgets what was seen";
}

TEST(DepthState, WithoutTheMaskFragmentsAreSeenButStoreNothing) {
  Bench bench;
  bench.draw(full(0.5f));
  bench.draw(full(0.25f), {.mask = false});
  EXPECT_EQ(bench.seen(), 1);
  EXPECT_NEAR(bench.depth(), 0.5, 1e-6);
  bench.draw(full(0.4f));
  EXPECT_EQ(bench.seen(), 2) << "0.25 was not stored, so 0.4 passes";
}

// All depths are drawn first, then only equal depths: nothing is visible that was not nearest.
TEST(DepthState, EqualAfterAPrepassSeesTheSame) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 80, 3));
  const Surfaces surfaces(scene);
  Random random(2);
  const View view = random_view(random, 150, 120);
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d24, DepthFormat::f32}) {
    DepthBuffer once(150, 120, 1, format), twice(150, 120, 1, format);
    once.draw(surfaces, view, {.state = {.func = DepthFunc::less_equal}});
    twice.draw(surfaces, view, {.state = {.func = DepthFunc::less}});
    twice.draw(surfaces, view, {.state = {.func = DepthFunc::equal, .mask = false}});
    EXPECT_EQ(content_hash(once.visible(view)), content_hash(twice.visible(view)));
  }
}

TEST(DepthState, TheDepthRangeScalesAndReverses) {
  for (const auto& [near, far, expected] :
       {std::tuple(0.0, 1.0, 0.25), {0.5, 1.0, 0.625}, {1.0, 0.0, 0.75}, {0.3, 0.3, 0.3}, {0.5, 0.25, 0.4375}}) {
    Bench bench(DepthFormat::f32);
    bench.draw(full(0.25f), {.func = DepthFunc::always, .range_near = near, .range_far = far});
    EXPECT_FLOAT_EQ(float(bench.depth()), float(expected));
    // With the range reversed, nearer means greater.
    bench.draw(full(0.25f),
               {.func = DepthFunc::equal, .range_near = far, .range_far = near, .nearer_is_greater = true});
    EXPECT_EQ(bench.seen(), 1);
  }
  // A sky drawn into [1, 1] is behind everything, and passes only where nothing else is.
  Bench bench;
  bench.draw(full(0.9f));
  bench.draw(full(0.1f), {.func = DepthFunc::less_equal, .range_near = 1, .range_far = 1});
  EXPECT_EQ(bench.seen(), 0);
}

// near = 1, far = 100: the table of docs/conventions.md, at distance 2.
TEST(DepthState, PerspectiveDepthIsThatOfTheMatrix) {
  View view;
  view.width = view.height = kSide;
  view.projection = make_projection(1.0, 1.0, {1, 100});
  Mesh mesh;
  add_triangle(mesh, {-9, -9, -2}, {9, -9, -2}, {0, 20, -2});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  DepthBuffer buffer(kSide, kSide, 1, DepthFormat::f32);
  buffer.draw(surfaces, view, {.state = {.func = DepthFunc::always}});
  EXPECT_FLOAT_EQ(buffer.depths()[27], 0.5050505f);
  for (const bool nearer_is_greater : {false, true}) {
    buffer.draw(surfaces, view, {.state = {.func = DepthFunc::always, .nearer_is_greater = nearer_is_greater}});
    const DepthConvention convention = nearer_is_greater ? reversed_depth : zero_to_one_depth;
    EXPECT_NEAR(distance_of_depth(view.projection, convention, double(buffer.depths()[27])), 2, 1e-5);
  }
}

// One unit is one step of the format: the smallest offset that is always resolved.
TEST(PolygonOffset, AUnitIsOneStep) {
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24, DepthFormat::f32})
    for (const float depth : {0.11f, 0.3f, 0.52f, 0.77f, 0.985f}) {
      Bench bench(format);
      bench.draw(full(depth), {.func = DepthFunc::always});
      const std::uint32_t plain = bench.buffer.stored()[0];
      bench.draw(full(depth), {.func = DepthFunc::always, .offset = {0, 1}});
      EXPECT_EQ(bench.buffer.stored()[0], plain + 1) << depth;
      bench.draw(full(depth), {.func = DepthFunc::always, .offset = {0, -3}});
      EXPECT_EQ(bench.buffer.stored()[0], plain - 3) << depth;
    }
}

// A decal in the plane of its wall: LESS hides it without an offset, and shows it with one unit towards the eye.
TEST(PolygonOffset, DecalsComeToTheFront) {
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24, DepthFormat::f32}) {
    Bench bench(format);
    bench.draw(full(0.6f));
    bench.draw(full(0.6f));
    EXPECT_EQ(bench.seen(), 0);
    bench.draw(full(0.6f), {.offset = {-1, -1}});
    EXPECT_EQ(bench.seen(), 2);
  }
}

// A plane that rises by 1/16 a pixel to the right and falls by 1/32 downwards has m = 1/16.
TEST(PolygonOffset, TheFactorScalesTheGreaterSlope) {
  const auto depth_at = [](float x, float y) { return 0.25f + x / 16 - (kSide - y) / 64; };
  const auto corner = [&](float x, float y) { return glm::vec3(x, y, -depth_at(x, y)); };
  Mesh mesh;
  add_triangle(mesh, corner(0, 0), corner(kSide, 0), corner(kSide, kSide));
  add_triangle(mesh, corner(0, 0), corner(kSide, kSide), corner(0, kSide));
  Bench bench(DepthFormat::f32);
  bench.draw(mesh, {.func = DepthFunc::always});
  const double plain = bench.depth();
  for (const double factor : {1.0, -1.0, 2.0, 0.5}) {
    bench.draw(mesh, {.func = DepthFunc::always, .offset = {factor, 0}});
    EXPECT_NEAR(bench.depth(), plain + factor / 16, 1e-6);
  }
  bench.draw(mesh, {.func = DepthFunc::always, .offset = {2, 0, 0.03}});
  EXPECT_NEAR(bench.depth(), plain + 0.03, 1e-6);
  bench.draw(mesh, {.func = DepthFunc::always, .offset = {-2, 0, 0.03}});
  EXPECT_NEAR(bench.depth(), plain - 0.125, 1e-6) << "a positive clamp limits from above";
  bench.draw(mesh, {.func = DepthFunc::always, .offset = {-2, 0, -0.03}});
  EXPECT_NEAR(bench.depth(), plain - 0.03, 1e-6);
  // Half the range gives half the slope.
  bench.draw(mesh, {.func = DepthFunc::always, .range_far = 0.5});
  const double halved = bench.depth();
  bench.draw(mesh, {.func = DepthFunc::always, .range_far = 0.5, .offset = {1, 0}});
  EXPECT_NEAR(bench.depth(), halved + 1.0 / 32, 1e-6);
}

TEST(PolygonOffset, ResultsStayWithinZeroAndOne) {
  for (const DepthFormat format : {DepthFormat::d24, DepthFormat::f32}) {
    Bench bench(format);
    bench.draw(full(0.5f), {.func = DepthFunc::always, .offset = {0, 1e12}});
    EXPECT_EQ(bench.depth(), 1);
    bench.draw(full(0.5f), {.func = DepthFunc::always, .offset = {0, -1e12}});
    EXPECT_EQ(bench.depth(), 0);
  }
}

TEST(StoredDepth, RoundsToTheNearestAndBack) {
  EXPECT_EQ(stored_depth(DepthFormat::d8, 0.5), 128u);
  EXPECT_EQ(stored_depth(DepthFormat::d8, 0.49), 125u);
  EXPECT_EQ(stored_depth(DepthFormat::d24, 1), 16777215u);
  EXPECT_EQ(stored_depth(DepthFormat::d24, 2), 16777215u);
  EXPECT_EQ(stored_depth(DepthFormat::f32, 1), 0x3F800000u);
  EXPECT_EQ(stored_depth(DepthFormat::f32, -0.0), 0u);
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24})
    for (std::uint32_t i = 0; i < std::uint32_t(1) << integer_bits(format); i += i < 65536 ? 1 : 1013) {
      const double depth = depth_of_stored(format, i), half = 0.499 / double((1u << integer_bits(format)) - 1);
      ASSERT_EQ(stored_depth(format, depth), i);
      ASSERT_EQ(stored_depth(format, depth + half), i);
      ASSERT_EQ(stored_depth(format, depth - half), i);
      // Depths converted to float still tell the integers apart.
      ASSERT_EQ(stored_depth(format, double(float(depth))), i);
    }
}

TEST(DepthBuffer, BadArgumentsAreRefusedByName) {
  const auto message = [](const auto& action) -> std::string {
    try {
      action();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message([] { DepthBuffer(0, 8); }), "width: must be 1 to 16384");
  EXPECT_EQ(message([] { DepthBuffer(8, 8, 3); }), "samples: must be 1, 2, 4, 8 or 16");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Bench bench;
  EXPECT_EQ(message([&] { bench.buffer.clear(nan); }), "clear: the depth must be a finite number");
  const Mesh mesh = full(0.5f);
  EXPECT_EQ(message([&] { bench.draw(mesh, {.range_near = -0.1}); }), "depth range: both ends must be from 0 to 1");
  EXPECT_EQ(message([&] { bench.draw(mesh, {.range_far = nan}); }), "depth range: both ends must be from 0 to 1");
  EXPECT_EQ(message([&] { bench.draw(mesh, {.offset = {nan, 0}}); }), "polygon offset: must be within 1e30");
  EXPECT_EQ(message([&] { bench.draw(mesh, {.func = DepthFunc(9)}); }), "depth function: there are eight");
  bench.ids = no_primitive - 1;
  EXPECT_EQ(message([&] { bench.draw(mesh); }), "id offset: ids would exceed 4294967294");
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View view = flat_view();
  view.width = 9;
  EXPECT_EQ(message([&] { bench.buffer.draw(surfaces, view); }),
            "view: width, height and samples must be those of the depth buffer");
}

}  // namespace
}  // namespace frontmost::test
