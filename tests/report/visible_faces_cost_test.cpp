// SPDX-License-Identifier: Apache-2.0
// Visible faces of meshes made to take long: the right areas after few steps, or an error after some.
#include <gtest/gtest.h>

#include "frontmost/report.h"
#include "report/faces/viewed_faces.h"
#include "support/costly_meshes.h"
#include "support/effort.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

/// A view of 64 x 64 pixels, 16 pixels a unit.
View parallel_view(const glm::dvec3& from) {
  View view;
  view.width = view.height = 64;
  view.world_from_eye = look_at(from, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-2, 2, -2, 2, {1, 20});
  return view;
}

/// Areas in pixels by id. The search may ask at most `most_questions` times whether to stop: once in 65,536 steps, and
/// once in eight cells.
std::vector<double> areas_of(const Mesh& mesh, const View& view, std::size_t most_questions) {
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const CountingWatch watch;
  std::vector<double> areas(surfaces.primitive_count(), 0);
  for (const VisibleFace& face : visible_faces(surfaces, view, watch.execution()).faces) areas[face.id] = face.pixels;
  EXPECT_LT(watch.asked(), most_questions);
  return areas;
}

double sum_of(const std::vector<double>& areas) {
  double sum = 0;
  for (const double area : areas) sum += area;
  return sum;
}

TEST(CostOfVisibleFaces, TurnedTrianglesInOnePlane) {
  const int count = 625;
  const std::vector<double> areas = areas_of(turned_triangles(count), parallel_view({0, 0, 10}), 2500);
  EXPECT_NEAR(areas[0], 256 * 0.75 * std::sqrt(3.0), 1e-4) << "the lowest id is seen whole";
  // The union is a star of 3 * count tips with angles of 60 degrees; neighbouring tips meet in a valley.
  const double half = glm::radians(60.0) / count, valley = 0.5 / std::sin(glm::radians(150.0) - half);
  EXPECT_NEAR(sum_of(areas), 256 * 3 * count * valley * std::sin(half), 1e-4);
}

TEST(CostOfVisibleFaces, NestedSheetsInOnePlane) {
  const int count = 2000;
  const std::vector<double> areas = areas_of(nested_sheets(count), parallel_view({0, 0, 10}), 5000);
  for (int i = 1; i < count; ++i) {
    const double half = 0.1f + 0.9f * float(i) / float(count), before = 0.1f + 0.9f * float(i - 1) / float(count);
    ASSERT_NEAR(areas[std::size_t(2 * i)] + areas[std::size_t(2 * i + 1)], 1024 * (half * half - before * before), 1e-4)
        << i;
  }
}

TEST(CostOfVisibleFaces, SheetsCloseBehindEachOther) {
  const int count = 1000;
  const double gap = 1e-7, thickness = gap * (count - 1);
  const View view = parallel_view({2, 3, 4});
  const std::vector<double> areas = areas_of(parallel_sheets(count, gap), view, 1500);
  // A prism, except for steps at its rim of less than a millionth of a pixel.
  const auto on_screen = [&](const glm::dvec3& v) {
    return 16.0 * glm::dvec2(glm::dot(v, view.right()), glm::dot(v, view.up()));
  };
  const auto area = [](const glm::dvec2& a, const glm::dvec2& b) { return std::abs(a.x * b.y - a.y * b.x); };
  const glm::dvec2 x = on_screen({2, 0, 0}), y = on_screen({0, 2, 0}), z = on_screen({0, 0, thickness});
  EXPECT_NEAR(sum_of(areas), area(x, y) + area(x, z) + area(y, z), 1e-4);
  for (std::size_t i = 0; i < areas.size(); i += 2) ASSERT_GT(areas[i] + areas[i + 1], 0) << i;
}

TEST(CostOfVisibleFaces, TooMuchIsRefusedAndSaysWhere) {
  const Scene scene = scene_of(slivers_through_point(2000));
  const Surfaces surfaces(scene);
  const View view = parallel_view({0, 0, 10});
  const std::vector<EdgeNeighbours> sides = faces_detail::sides_of_meshes(scene, {});
  for (const int threads : {1, 4})
    EXPECT_EQ(
        refusal_of(ErrorCode::limit_exceeded,
                   [&] { (void)faces_detail::find_faces(surfaces, view, sides, 1 << 22, {.threads = threads}); }),
        "visible faces: too many faces overlap in the picture to cut them by each other: most of them, 2000, in the "
        "pixels from 0,0 to 32,32, among them face 0 of object 0; leave out faces that lie there many times");
}

}  // namespace
}  // namespace frontmost::test
