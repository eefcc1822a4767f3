// SPDX-License-Identifier: Apache-2.0
// Scenes made to take long: they end at a limit, or as soon as they are told to stop.

#include "painter/painted.h"
#include "painter/trapped.h"
#include "support/costly_meshes.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

/// Triangles that all intersect near the origin. `are_pairs`: two lie in every plane, one turned about its middle; all
/// are on a grid, without rounding.
Scene all_crossing(int count, bool are_pairs = false) {
  Random random(1);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto on_grid = [&](float reach) { return glm::round(random.point(reach * 1024)) / 1024.0f; };
    const glm::vec3 a = on_grid(1), b = on_grid(1), middle = on_grid(0.03f), c = 3.0f * middle - a - b;
    add_triangle(mesh, a, b, c);
    if (are_pairs) add_triangle(mesh, 2.0f * middle - a, 2.0f * middle - b, 2.0f * middle - c);
  }
  return scene_of(mesh);
}

class Foreseen : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Hostile, Foreseen, testing::Bool(),
                         [](const auto& p) { return p.param ? "TwoInEveryPlane" : "AllInTheirOwn"; });

/// Work that no number of cuts within the limit can do is refused before the cuts; polls count the steps.
TEST_P(Foreseen, TooManyCuts) {
  const Scene scene = all_crossing(3000, GetParam());
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 64, 64);
  for (const PaintMethod method : {PaintMethod::depth_sort, PaintMethod::bsp}) {
    const CountingWatch watch;
    try {
      (void)painter(surfaces, view, {.method = method}, watch.execution());
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "painter: more than 1048576 cuts: too many triangles intersect");
    }
    EXPECT_LT(watch.asked(), 100u) << "4096 steps each";
  }
}

/// An equal number of pairs intersect, but all in the same two planes.
TEST(Hostile, TwoPlanesThroughEachOtherAreNotTooMany) {
  Mesh mesh;
  for (int i = 0; i < 1000; ++i) {
    const float width = 1 + float(i) / 1024;
    add_triangle(mesh, {-width, -1, 0.125f}, {width, -1, 0.125f}, {0, 1, 0.25f});
    add_triangle(mesh, {-width, 1, 0.1875f - 0.0625f * width}, {0, -1, 0.1875f}, {width, 1, 0.1875f + 0.0625f * width});
  }
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 64, 64);
  const PaintOrder order = painter(surfaces, view, {.method = PaintMethod::bsp, .most_cuts = 2000});
  EXPECT_GT(order.steps.cuts, 900u);
}

/// Two intersecting triangles, many times at the same places: all copies are painted, but cost the work of two.
TEST(Hostile, CopiesAreHeldAgainstOthersOnce) {
  Mesh mesh;
  const int count = 500;
  for (int i = 0; i < count; ++i) {
    add_triangle(mesh, {-1, -1, 0.125f}, {1, -1, 0.125f}, {0, 1, 0.25f});
    // The second triangle has the reverse winding and another first vertex.
    add_triangle(mesh, {0, -1, 0.25f}, {-1, 1, 0.25f}, {1, 1, 0.125f});
  }
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 64, 64);
  for (const PaintMethod method : {PaintMethod::depth_sort, PaintMethod::bsp}) {
    const Painted found = painted(surfaces, view, method);
    EXPECT_EQ(found.unexplained, 0u);
    const PaintSteps& steps = found.order.steps;
    EXPECT_LE(steps.cuts, 2u);
    EXPECT_LT(steps.behind + steps.before + steps.projections_apart + steps.compared, 20u);
    EXPECT_EQ(found.order.polygons.size(), count * (2 + steps.cuts));
    // Copies at one place follow each other, the lowest id last.
    for (std::size_t i = 0; i < found.order.polygons.size(); ++i) {
      const auto from_top = PrimitiveId(count - 1 - int(i) % count);
      EXPECT_EQ(found.order.polygons[i].id / 2, from_top) << i;
    }
  }
  EXPECT_THROW((void)painter(surfaces, view, {.most_polygons = 2 * count}), Error);
  const PaintOrder seen = painter(surfaces, view, {.occluders = Occluders::all()});
  EXPECT_LE(seen.polygons.size(), 4u);
}

/// All blades intersect, but along one line: each is cut there at most once.
TEST(Hostile, BladesAroundAnAxisAreFewCuts) {
  Random random(4);
  Mesh mesh;
  const int count = 300;
  for (int i = 0; i < count; ++i) {
    const float around = float(M_PI) * float(i) / float(count), x = std::cos(around), z = std::sin(around);
    const float low = random.unit();
    add_triangle(mesh, {x, low, z}, {-x, low, -z}, {x / 2, low + 2, z / 2});
  }
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const PaintOrder order = painter(surfaces, frame(surfaces, 64, 64), {.most_cuts = 2000});
  EXPECT_GE(order.steps.cuts, std::uint64_t(count) / 2);
  EXPECT_LE(order.steps.cuts, std::uint64_t(count) * 2);
}

/// Asks work to stop, from a certain question on.
class Stopper {
 public:
  explicit Stopper(std::size_t question) : watch_(question), last_(question + kThreads) {}
  [[nodiscard]] Execution execution() const { return watch_.execution(kThreads); }

  /// Every thread stops at the first "yes", and the one that began the work asks once more.
  template <class Work>
  void expect_heard(const Work& work) const {
    try {
      work();
      ADD_FAILURE() << "was not stopped";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled) << error.what();
    }
    EXPECT_LE(watch_.asked(), last_);
  }

 private:
  static constexpr int kThreads = 2;
  CountingWatch watch_;
  std::size_t last_;
};

TEST(Hostile, CutsEndAtTheirLimit) {
  const Scene scene = all_crossing(150);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 64, 64);
  for (const PaintMethod method : {PaintMethod::depth_sort, PaintMethod::bsp}) try {
      (void)painter(surfaces, view, {.method = method, .most_cuts = 2000});
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
      EXPECT_STREQ(error.what(), "painter: more than 2000 cuts: too many triangles intersect");
    }
}

/// Parallel and tilted triangles: their depths overlap, and so do they on the screen.
Scene stack(int count) {
  Random random(2);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float z = random.within(-1, 1);
    add_triangle(mesh, {-1, -1, z - 0.7f}, {1, -1, z + 0.2f}, {0, 1, z + 0.5f});
  }
  return scene_of(mesh);
}

TEST(Hostile, StacksArePassedOverManyAtATime) {
  const int count = tries_little ? 3000 : 20000;
  const Scene scene = stack(count);
  const Surfaces surfaces(scene);
  const PaintOrder order = painter(surfaces, frame(surfaces, 64, 64));
  ASSERT_EQ(order.polygons.size(), std::size_t(count));
  for (std::size_t i = 1; i < order.polygons.size(); ++i)
    ASSERT_LE(surfaces.corners(order.polygons[i - 1].id)[0].z, surfaces.corners(order.polygons[i].id)[0].z);
  // Not every pair is tested: each triangle is tested against those of its own box and a few others.
  EXPECT_LT(order.steps.behind, std::uint64_t(count) * 200);
}

TEST(Hostile, OrdersStopWhenTold) {
  const Scene scene = all_crossing(1500);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 256, 256);
  for (const PaintMethod method : {PaintMethod::depth_sort, PaintMethod::bsp}) {
    const Stopper stopper(30);
    stopper.expect_heard(
        [&] { (void)painter(surfaces, view, {.method = method, .most_cuts = 1 << 30}, stopper.execution()); });
  }
}

/// Orders ask once in some thousand tests, and in some hundred cuts, which take longer.
TEST(Hostile, OrdersAskOften) {
  for (const Scene& scene : {stack(20000), all_crossing(60)}) {
    const Surfaces surfaces(scene);
    const CountingWatch watch;
    const PaintOrder order = painter(surfaces, frame(surfaces, 256, 256), {.most_cuts = 1 << 30}, watch.execution());
    const std::uint64_t tests = order.steps.behind, cuts = order.steps.cuts;
    EXPECT_GT(tests + cuts, 20'000u);
    EXPECT_GT(watch.asked(), tests / 4096 + cuts / 256);
  }
}

TEST(Hostile, PartsAndTrapsStopWhenTold) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 40000, 1));
  const Surfaces surfaces(scene);
  const PaintOrder order = painter(surfaces, frame(surfaces, 256, 256), {.method = PaintMethod::centroid});
  const Stopper parts(30);
  parts.expect_heard([&] { (void)visible_parts(order, Occluders::all(), parts.execution()); });
  const Stopper traps(30);
  traps.expect_heard([&] { (void)trapped(order, 1, Occluders::all(), traps.execution()); });
}

TEST(TooMuch, StripsOverEachOther) {
  const Scene scene = scene_of(crossing_strips(10000));
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 640, 480);
  EXPECT_EQ(
      refusal_of(ErrorCode::limit_exceeded, [&] { (void)painter(surfaces, view, {.occluders = Occluders::all()}); }),
      "painter: too many of 20000 triangles and pieces overlap in one place of the picture");
}

}  // namespace
}  // namespace frontmost::test
