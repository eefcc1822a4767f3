// SPDX-License-Identifier: Apache-2.0
// Views and scenes at the limits of numbers: each is refused by name, or equals the oracle.

#include <gtest/gtest.h>

#include <cstring>

#include "frontmost/zbuffer.h"
#include "support/odd_numbers.h"
#include "support/oracle.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

View straight_on(const Projection& projection, double distance = 3) {
  return {40, 30, 1, look_at({0, 0, distance}, {0, 0, 0}, {0, 1, 0}), projection, {}};
}

/// Draws `view` on every instruction set. \returns the number of covered samples, or -1 if the view is refused.
int samples_seen(const Scene& scene, const View& view) {
  const Surfaces surfaces(scene);
  try {
    validate(view);
  } catch (const Error&) {
    EXPECT_THROW((void)draw_both_ways(surfaces, view), Error);
    return -1;
  }
  const Visible expected = oracle(surfaces, view);
  int seen = 0;
  for (std::size_t i = 0; i < expected.keys.size(); ++i) {
    EXPECT_TRUE(expected.keys[i] >= 0 && expected.keys[i] <= 1);
    seen += expected.primitives[i] != no_primitive;
  }
  for (const Isa isa : available_isas()) {
    const Visible found = draw_both_ways(surfaces, view, {.threads = 1, .isa = isa});
    EXPECT_EQ(std::memcmp(expected.keys.data(), found.keys.data(), 4 * expected.keys.size()), 0) << name(isa);
    EXPECT_EQ(std::memcmp(expected.primitives.data(), found.primitives.data(), 4 * expected.keys.size()), 0)
        << name(isa);
  }
  return seen;
}

/// Counts the views that are drawn and compared, and those that see something: a test that refuses all of them proves
/// nothing.
class Cases {
 public:
  void draw(const Scene& scene, const View& view) {
    const int seen = samples_seen(scene, view);
    drawn_ += seen >= 0;
    seeing_ += seen > 0;
  }
  void expect(int drawn, int seeing) const {
    EXPECT_EQ(drawn_, drawn);
    EXPECT_EQ(seeing_, seeing);
  }

 private:
  int drawn_ = 0, seeing_ = 0;
};

Scene soup(float scale = 1) {
  Mesh mesh = random_mesh(Kind::soup, 60, 3);
  for (glm::vec3& p : mesh.positions) p *= scale;
  return scene_of(mesh);
}

// The one-lane target has no instruction for rounding, and vertices of clusters and of clipped triangles take two
// paths.
TEST(Extreme, EveryInstructionSetSnapsToTheNearestUnit) {
  for (const float x : {0.49999997f, 0.5f, 0.50000006f, 1.5f, 2.5f, -0.49999997f, -0.5f, -1.5f}) {
    SCOPED_TRACE(x);
    Mesh mesh;
    add_triangle(mesh, {x, -200, 0}, {300, 0, 0}, {x, 200, 0});
    // One pixel, with one 1/256 pixel for a scene unit, and its sample at 0: a triangle to its left is seen or not.
    View view = straight_on(make_orthographic(-128, 128, -128, 128, {1, 5}));
    view.width = view.height = 1;
    EXPECT_EQ(samples_seen(scene_of(mesh), view), std::nearbyint(x) <= 0 ? 1 : 0);
  }
}

TEST(Extreme, NearAndFarPlanes) {
  Cases cases;
  const Scene scene = soup();
  for (const double near : {5e-324, 1e-300, 1e-46, 1e-45, 1e-39, 1.2e-38, 1e-37, 1e-30, 1e-20, 1e-10})
    for (const double far : {1e-5, 3.0, 1e8, 1e38, 1e39, 1e300, kInfinity}) {
      SCOPED_TRACE(testing::Message() << "near " << near << " far " << far);
      cases.draw(scene, straight_on(make_projection(0.8, 1, {near, far}), 0.3));
    }
  for (const double near : {-1e300, -1e39, -1e38, -1e10, -5.0, 0.0, 1e-45, 2.0})
    for (const double far : {1e-45, 2.5, 1e10, 1e38, 1e39, 1e300}) {
      if (far <= near) continue;
      SCOPED_TRACE(testing::Message() << "orthographic near " << near << " far " << far);
      cases.draw(scene, straight_on(make_orthographic(-1, 1, -1, 1, {near, far})));
    }
  cases.draw(scene, straight_on(make_orthographic(-1, 1, -1, 1, {3, 3 + 1e-15})));
  cases.draw(scene, straight_on(make_orthographic(-1, 1, -1, 1, {0, 1e-42})));
  cases.expect(64, 54);
}

TEST(Extreme, KeysThatAreDenormal) {
  const Scene scene = soup(1e3f);
  EXPECT_GT(samples_seen(scene, straight_on(make_projection(0.8, 1, {2e-38, kInfinity}), 3e3)), 100);
  EXPECT_GT(samples_seen(scene, straight_on(make_projection(0.8, 1, {1e-36, kInfinity}), 3e3)), 100);
}

TEST(Extreme, FieldsOfView) {
  Cases cases;
  constexpr double kPi = 3.14159265358979323846;
  const Scene scene = soup();
  for (const double fov : {1e-300, 1e-40, 1e-30, 1e-20, 1e-7, 1e-3, 3.0, 3.14159, kPi - 1e-12, std::nextafter(kPi, 0)})
    for (const double aspect : {1e-300, 1e-30, 1e-5, 1.0, 1e5, 1e30, 1e300}) {
      SCOPED_TRACE(testing::Message() << "field of view " << fov << " aspect " << aspect);
      try {
        cases.draw(scene, straight_on(make_projection(fov, aspect, {0.1, kInfinity})));
      } catch (const Error&) {
      }
    }
  for (const double side : {1e-300, 1e-38, 1e-20, 1e20, 1e38, 1e300}) {
    SCOPED_TRACE(testing::Message() << "orthographic " << side);
    cases.draw(scene, straight_on(make_orthographic(-side, side, -side, side, {1, 5})));
    cases.draw(scene, straight_on({false, side, 2 * side, side, 2 * side, {1, 5}}));
  }
  cases.expect(60, 3);
}

TEST(Extreme, EyesFarAway) {
  Cases cases;
  const Scene scene = soup();
  for (const double distance : {1e3, 1e10, 1e20, 1e30, 1e38, 1e39, 1e100, 1e150, 1e300})
    for (const bool orthographic : {false, true}) {
      SCOPED_TRACE(testing::Message() << "distance " << distance);
      const Projection projection = orthographic ? make_orthographic(-1, 1, -1, 1, {0.5 * distance, 2 * distance})
                                                 : make_projection(2 / distance, 1, {0.5 * distance, 2 * distance});
      View view = straight_on(projection);
      view.world_from_eye[3] = {0, 0, distance, 1};
      cases.draw(scene, view);
      view.world_from_eye[3] = {distance, -distance, distance, 1};
      cases.draw(scene, view);
    }
  cases.expect(17, 9);
}

TEST(Extreme, ModelsOfAnySize) {
  Cases cases;
  for (const float scale : {1e-44f, 1e-38f, 1e-30f, 1e-20f, 1e20f, 1e30f, 1e33f, 1e36f, 2e38f}) {
    SCOPED_TRACE(scale);
    const Scene scene = soup(scale);
    for (const double far : {kInfinity, 100.0 * scale}) {
      const double near = std::max(0.1 * double(scale), 1e-37);
      cases.draw(scene, straight_on(make_projection(0.8, 1, {near, std::max(far, 2 * near)}), 3.0 * scale));
      cases.draw(scene, straight_on(make_projection(0.8, 1, {1e-3, kInfinity}), 0.3 * scale));
      cases.draw(scene, straight_on(make_projection(1e-6, 1, {1e-3, kInfinity}), 3.0 * scale));
    }
    cases.draw(scene, straight_on(make_orthographic(-scale, scale, -scale, scale, {0, 6.0 * scale}), 3.0 * scale));
  }
  cases.expect(56, 26);
}

}  // namespace
}  // namespace frontmost::test
