// SPDX-License-Identifier: Apache-2.0
// Right answers are explained, and wrong ones are found, whatever the mistake.
#include <gtest/gtest.h>

#include "frontmost/painter.h"
#include "frontmost/precision.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "report/sample_square.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

/// A view along -z from the origin.
View square_view() {
  View view;
  view.width = view.height = 64;
  view.projection = make_projection(1.0, 1.0, {0.5, 100});
  return view;
}

/// Triangles 0 and 1 fill the view at distance 5, 2 and 3 fill it at `behind`; 4 is small, far to the left at distance
/// 3.
Scene sheets(float behind) {
  Mesh mesh;
  for (const float z : {-5.0f, -behind}) {
    add_triangle(mesh, {-9, -9, z}, {9, -9, z}, {9, 9, z});
    add_triangle(mesh, {-9, -9, z}, {9, 9, z}, {-9, 9, z});
  }
  add_triangle(mesh, {-1.4f, 0, -3}, {-1.2f, 0, -3}, {-1.3f, 0.1f, -3});
  return scene_of(mesh);
}

std::uint64_t unexplained(const Surfaces& surfaces, const Visible& right, const Visible& wrong) {
  const std::uint64_t count = check_agreement(surfaces, right, wrong).count(Difference::unexplained);
  EXPECT_EQ(check_agreement(surfaces, wrong, right).count(Difference::unexplained), count) << "it depends on the order";
  return count;
}

TEST(Agreement, AnAnswerAgreesWithItself) {
  const Scene scene = sheets(6);
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, square_view());
  const Agreement answer = check_agreement(surfaces, visible, visible);
  EXPECT_EQ(answer.differing(), 0u);
  EXPECT_EQ(answer.count(Difference::none), 64u * 64u);
}

TEST(Agreement, EverySingleMistakeIsFound) {
  const Scene scene = sheets(6);
  const Surfaces surfaces(scene);
  const Visible right = zbuffer(surfaces, square_view());
  const std::size_t at = right.index(40, 20);  // far from every edge
  const auto with = [&](PrimitiveId id, float key) {
    Visible wrong = right;
    wrong.primitives[at] = id;
    wrong.keys[at] = key;
    return unexplained(surfaces, right, wrong);
  };
  const PrimitiveId seen = right.primitives[at];
  const float key = right.keys[at];
  ASSERT_LT(seen, 2u);
  EXPECT_EQ(with(seen, key), 0u);
  EXPECT_EQ(with(no_primitive, 0), 1u) << "a hole";
  EXPECT_EQ(with(1 - seen, key), 1u) << "the neighbour, which is elsewhere";
  EXPECT_EQ(with(seen + 2, 0.5f / 6), 1u) << "what is behind";
  EXPECT_EQ(with(4, 0.5f / 3), 1u) << "a triangle that is elsewhere";
  EXPECT_EQ(with(5, key), 1u) << "a triangle that is not there";
  EXPECT_EQ(with(seen, key * 1.0001f), 1u) << "too near";
  EXPECT_EQ(with(seen, key * 0.9999f), 1u) << "too far";
  EXPECT_EQ(with(seen, 0), 1u) << "without a depth";
  EXPECT_EQ(with(seen, std::numeric_limits<float>::quiet_NaN()), 1u) << "no depth at all";
  EXPECT_EQ(with(no_primitive, key), 1u) << "a depth of nothing";
}

// At an edge two answers are possible; a third is as wrong there as anywhere.
TEST(Agreement, AnEdgeExcusesOnlyWhatIsAtTheEdge) {
  const Scene scene = sheets(6);
  const Surfaces surfaces(scene);
  View view = square_view();
  const Visible right = zbuffer(surfaces, view);
  // The diagonal between 0 and 1 passes through pixel centres.
  const std::size_t at = right.index(20, 43);
  Visible other = right;
  other.primitives[at] = 1 - right.primitives[at];
  const Agreement answer = check_agreement(surfaces, right, other);
  EXPECT_EQ(answer.differences[at], Difference::edge);
  EXPECT_EQ(answer.differing(), 1u);
  // Triangle 4 lies behind the diagonal. Neither 0 nor 1 alone hides it there, but both together do.
  other.primitives[at] = 4;
  EXPECT_EQ(unexplained(surfaces, right, other), 1u);
}

TEST(Agreement, SurfacesInOnePlaceMayBeSeenEitherWay) {
  const Scene scene = sheets(5);
  const Surfaces surfaces(scene);
  const Visible right = zbuffer(surfaces, square_view());
  Visible other = right;
  std::uint64_t changed = 0;
  for (int i = 0; i < 30; ++i, ++changed) other.primitives[right.index(15 + i, 10)] += 2;
  const Agreement answer = check_agreement(surfaces, right, other);
  EXPECT_EQ(answer.count(Difference::depth), changed);
  EXPECT_EQ(answer.differing(), changed);
}

TEST(Agreement, CulledTrianglesAreNoExcuseAndNoObstacle) {
  const Scene scene = sheets(6);
  const Surfaces surfaces(scene);
  View view = square_view();
  view.culling = Culling::back;  // all face the eye
  const Visible right = zbuffer(surfaces, view);
  const std::size_t at = right.index(40, 20);
  Visible wrong = right;
  wrong.primitives[at] += 2;
  wrong.keys[at] = 0.5f / 6;
  EXPECT_EQ(unexplained(surfaces, right, wrong), 1u);
  view.culling = Culling::front;
  const Visible nothing = zbuffer(surfaces, view);
  ASSERT_EQ(nothing.primitives[at], no_primitive);
  wrong = nothing;
  wrong.primitives[at] = right.primitives[at];
  wrong.keys[at] = right.keys[at];
  EXPECT_EQ(unexplained(surfaces, nothing, wrong), 1u);
}

/// The answer of check_agreement() at a sample whose ids differ, by a test of every triangle.
Difference asked_of_all(const Surfaces& surfaces, const SampleRays& rays, Culling culling,
                        const std::array<PrimitiveId, 2>& ids, const SampleSquare& square) {
  const auto meeting_of = [&](const ViewedTriangle& triangle) {
    const LineMeeting meeting = triangle.meeting(square);
    const bool is_culled = culling == Culling::back && triangle.facing() >= 0;
    return meeting == LineMeeting::contains && is_culled ? LineMeeting::misses : meeting;
  };
  bool all_contain = true;
  for (const PrimitiveId claim : ids) {
    std::optional<ViewedTriangle> claimed;
    if (claim != no_primitive) claimed.emplace(surfaces.corners(claim), rays);
    const LineMeeting meeting = claimed ? meeting_of(*claimed) : LineMeeting::touches;
    if (meeting == LineMeeting::misses) return Difference::unexplained;
    all_contain = all_contain && meeting == LineMeeting::contains;
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      if (id == claim) continue;
      const ViewedTriangle triangle(surfaces.corners(id), rays);
      if (meeting_of(triangle) == LineMeeting::contains && (!claimed || is_surely_nearer(triangle, *claimed, square)))
        return Difference::unexplained;
    }
  }
  return all_contain ? Difference::depth : Difference::edge;
}

/// Orders by centroids give many wrong answers with right depths.
TEST(Agreement, EveryTriangleIsHeardWhereverItHasSomethingToSay) {
  std::array<std::uint64_t, 5> found{};
  for (std::uint64_t seed = 0; seed < seeds(4 * std::size(all_kinds)); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed + 700);
    const Scene scene = scene_of(random_mesh(all_kinds[seed % std::size(all_kinds)], 80, seed));
    const Surfaces surfaces(scene);
    View view = random_view(random, 90, 70);
    view.culling = seed % 3 == 1 ? Culling::back : Culling::none;
    view.samples = seed % 2 ? 4 : 1;
    const Visible right = zbuffer(surfaces, view);
    const Visible naive = paint(surfaces, painter(surfaces, view, {.method = PaintMethod::centroid}));
    const Agreement answer = check_agreement(surfaces, right, naive);
    const SampleRays rays(view);
    for (int sample = 0; sample < view.samples; ++sample)
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
          const std::size_t at = right.index(x, y, sample);
          if (right.primitives[at] == naive.primitives[at]) continue;
          const SampleSquare square(rays, glm::ivec2(x, y) * 256 + sample_offsets(view.samples)[std::size_t(sample)]);
          ASSERT_EQ(answer.differences[at],
                    asked_of_all(surfaces, rays, view.culling, {right.primitives[at], naive.primitives[at]}, square))
              << x << ", " << y << ", " << sample;
          ++found[std::size_t(answer.differences[at])];
        }
  }
  for (const Difference difference : {Difference::edge, Difference::depth, Difference::unexplained})
    EXPECT_GT(found[std::size_t(difference)], 0u) << name(difference);
}

class MistakesInEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Agreement, MistakesInEveryKind, testing::ValuesIn(all_kinds));

/// Changing the key of a possible answer, or replacing the answer by a hole, makes it wrong.
TEST_P(MistakesInEveryKind, WrongDepthsAndForeignTrianglesAreFound) {
  std::size_t planted = 0;
  for (std::uint64_t seed = 0; seed < seeds(12); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed + 300);
    const Scene scene = scene_of(random_mesh(GetParam(), 60, seed));
    const Surfaces surfaces(scene);
    View view = random_view(random, 90, 70);
    view.samples = seed % 3 == 2 ? 2 : 1;
    const Visible right = zbuffer(surfaces, view), rays = raycast(surfaces, view);
    Visible wrong = rays;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < right.primitives.size(); ++i) {
      if (right.primitives[i] == no_primitive || random.below(20) != 0) continue;
      // No vertex has a key beyond 1, and no visible point lies at infinity.
      wrong.keys[i] = random.below(2) ? 1.5f : -0.5f;
      if (wrong.primitives[i] == no_primitive) continue;
      places.push_back(i);
    }
    const Agreement answer = check_agreement(surfaces, right, wrong);
    for (const std::size_t place : places) ASSERT_EQ(answer.differences[place], Difference::unexplained);
    planted += places.size();
    ASSERT_EQ(check_agreement(surfaces, right, rays).count(Difference::unexplained), 0u);
  }
  EXPECT_GT(planted, 0u);
}

TEST(Agreement, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = scene_of(random_mesh(Kind::coplanar, 300, 1));
  const Surfaces surfaces(scene);
  Random random(3);
  const View view = random_view(random, 200, 150);
  const Visible a = zbuffer(surfaces, view), b = raycast(surfaces, view);
  const Agreement one = check_agreement(surfaces, a, b, {.threads = 1}),
                  many = check_agreement(surfaces, a, b, {.threads = 5});
  EXPECT_GT(one.differing(), 0u);
  EXPECT_EQ(one.counts, many.counts);
  EXPECT_TRUE(std::equal(one.differences.begin(), one.differences.end(), many.differences.begin()));
}

TEST(Agreement, OnlyTranslucentTrianglesAreSeenThrough) {
  Scene scene = sheets(6);
  scene.materials.resize(2);
  scene.materials[1].alpha = Material::Alpha::blend;
  scene.meshes[0].material_ids = {0, 1, 0, 0, 0};
  const Surfaces surfaces(scene);
  const Visible front = zbuffer(surfaces, square_view());
  Visible behind = nothing_visible(square_view());
  for (const auto& [x, y] : {std::pair(50, 50), std::pair(5, 5)}) {  // on 0, and on 1
    behind.primitives[behind.index(x, y)] = front.primitives[front.index(x, y)] + 2;
    behind.keys[behind.index(x, y)] = 0.5f / 6;
  }
  Agreement answer = check_agreement(surfaces, front, front);
  see_through(answer, surfaces, front, behind);
  EXPECT_EQ(answer.differences[front.index(50, 50)], Difference::unexplained);
  EXPECT_EQ(answer.differences[front.index(5, 5)], Difference::translucent);
  EXPECT_EQ(answer.differing(), 2u);
  EXPECT_EQ(answer.count(Difference::none), 64u * 64u - 2);
}

// Between planes a few rounding errors apart, keys are coarse steps, which is not wrong.
TEST(Agreement, AFlatModelInParallelProjectionHasItsDepth) {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {10, 0, 0}, {10, 10, 0});
  add_triangle(mesh, {0, 0, 0}, {10, 10, 0}, {0, 10, 0});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  FrameOptions options;
  options.orthographic = true;
  options.direction = NamedView::front;
  const View view = frame(surfaces, 64, 48, options);
  EXPECT_EQ(check_agreement(surfaces, zbuffer(surfaces, view), raycast(surfaces, view)).count(Difference::unexplained),
            0u);
}

TEST(Agreement, RefusesAnswersOfDifferentViews) {
  const Scene scene = sheets(6);
  const Surfaces surfaces(scene);
  View other = square_view();
  const Visible a = zbuffer(surfaces, other);
  other.width = 63;
  EXPECT_THROW((void)check_agreement(surfaces, a, zbuffer(surfaces, other)), Error);
  other = square_view();
  other.world_from_eye = look_at({1, 0, 0}, {0, 0, -1}, {0, 1, 0});
  EXPECT_THROW((void)check_agreement(surfaces, a, zbuffer(surfaces, other)), Error);
}

TEST(Agreement, OfNothingIsComplete) {
  const Scene scene;
  const Surfaces surfaces(scene);
  const Visible a = zbuffer(surfaces, square_view());
  EXPECT_EQ(check_agreement(surfaces, a, a).count(Difference::none), 64u * 64u);
}

}  // namespace
}  // namespace frontmost::test
