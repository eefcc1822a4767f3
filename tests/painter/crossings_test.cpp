// SPDX-License-Identifier: Apache-2.0
// The number of cuts foreseen, against the cuts made.

#include "painter/painted.h"
#include "painter/stages.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace painter_detail;

/// Ways in which planes share lines: none; two in each plane; blades around several axes; vertices on a coarse grid;
/// blades among planes with lines of their own.
enum class Sharing { none, planes, axes, grid, mixed };

void add_blade(Mesh& mesh, const glm::vec3& axis, Random& random) {
  const glm::ivec2 way(random.below(201) - 100, 1 + random.below(100));
  const glm::vec3 aside = glm::vec3(float(way.x), 0, float(way.y)) / 128.0f;
  const float low = float(random.below(64)) / 128 - 1;
  add_triangle(mesh, axis + glm::vec3(aside.x, low, aside.z), axis + glm::vec3(-aside.x, low, -aside.z),
               axis + glm::vec3(aside.x / 2, low + 2, aside.z / 2));
}

void add_through_origin(Mesh& mesh, Random& random, bool are_pairs) {
  const auto on_grid = [&](float reach) { return glm::round(random.point(reach * 1024)) / 1024.0f; };
  const glm::vec3 a = on_grid(1), b = on_grid(1), middle = on_grid(0.03f), c = 3.0f * middle - a - b;
  add_triangle(mesh, a, b, c);
  if (are_pairs) add_triangle(mesh, 2.0f * middle - a, 2.0f * middle - b, 2.0f * middle - c);
}

Scene shared_lines(Sharing sharing, int count, std::uint64_t seed) {
  Random random(seed);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto on_coarse_grid = [&] { return glm::floor(random.point(2.999f)); };
    const glm::vec3 axis(float(i % 4) / 4, 0, float(i % 2) / 8);
    switch (sharing) {
      case Sharing::none: add_through_origin(mesh, random, false); break;
      case Sharing::planes: add_through_origin(mesh, random, true); break;
      case Sharing::axes: add_blade(mesh, axis, random); break;
      case Sharing::grid: {
        const glm::vec3 a = on_coarse_grid(), b = on_coarse_grid(), c = on_coarse_grid();
        add_triangle(mesh, a, b, c);
        break;
      }
      case Sharing::mixed:
        if (i % 2 == 0)
          add_blade(mesh, glm::vec3(0), random);
        else
          add_through_origin(mesh, random, false);
        break;
    }
  }
  return scene_of(mesh);
}

TEST(PaintCrossings, NoMoreCutsAreForeseenThanAreMade) {
  const int count = 50;
  for (const Sharing sharing : {Sharing::none, Sharing::planes, Sharing::axes, Sharing::grid, Sharing::mixed})
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      SCOPED_TRACE(int(sharing));
      const Scene scene = shared_lines(sharing, count, seed);
      const Surfaces surfaces(scene);
      const View view = frame(surfaces, 64, 64);
      Pieces pieces(view);
      const std::vector<std::uint32_t> members = gather(surfaces, view, pieces, {});
      const Execution execution;
      PaintEffort effort(execution, members.size());
      Poll poll(effort);
      const double foreseen = least_cuts(pieces, members, poll);
      const auto made = double(painter(surfaces, view, {.method = PaintMethod::bsp}).steps.cuts);
      EXPECT_LE(foreseen, made);
      // Most pairs are counted if each has a line of its own.
      if (sharing == Sharing::none) {
        EXPECT_GT(foreseen, 0.25 * count * (count - 1) / 2);
      }
    }
}

}  // namespace
}  // namespace frontmost::test
