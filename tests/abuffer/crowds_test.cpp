// SPDX-License-Identifier: Apache-2.0
// Long lists: many copies of the same triangles, and sheets that cross.

#include <gtest/gtest.h>

#include "fragment_oracle.h"
#include "support/effort.h"
#include "support/flat_picture.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

/// Two triangles that share an edge within the picture, both leaning, `count` times.
Scene copies_of_a_leaf(int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    add_triangle(mesh, {-1, -1, -0.2f}, {1, -1, 0.1f}, {1, 1, -0.3f});
    add_triangle(mesh, {-1, -1, -0.2f}, {1, 1, -0.3f}, {-1, 1, 0.2f});
  }
  return scene_of(std::move(mesh));
}

std::vector<glm::vec4> faint_colors(std::size_t count) {
  Random random(5);
  std::vector<glm::vec4> colors;
  for (std::size_t i = 0; i < count; ++i) {
    const float red = random.unit(), green = random.unit();
    colors.push_back({red, green, 0.5f, 0.02f});
  }
  return colors;
}

void expect_brute_force(const Scene& scene, const View& view, const AbufferOptions& options) {
  const std::vector<glm::vec4> colors = faint_colors(scene.meshes[0].triangles.size());
  const Scene faint = painted(scene, colors);
  const Surfaces surfaces(faint);
  const Image picture = flat_picture(surfaces, view, options, {.isa = Isa::best});
  const auto triangles = screen_triangles(surfaces, view);
  const auto samples = oracle_samples(view, options.grid);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const glm::dvec4 wanted = oracle_pixel(oracle_fragments(triangles, samples, x, y), samples, x, y, colors, 1);
      const glm::dvec4 found(pixel_of(picture, x, y));
      for (int k = 0; k < 4; ++k) ASSERT_NEAR(found[k], wanted[k], 3e-5) << x << ", " << y << ", channel " << k;
    }
  for (const Isa isa : available_isas())
    ASSERT_EQ(content_hash(flat_picture(surfaces, view, options, {.isa = isa})), content_hash(picture))
        << std::string(name(isa));
}

// Lists of 100 are processed sixteen pixels at a time, lists of 400 pixel by pixel. Where the shared edge crosses a
// pixel, copies of one triangle are compared with copies of the other in vain. With 400 copies, these are more pairs
// than are examined.
TEST(LongLists, OfCopiesEqualBruteForce) {
  for (const int count : {100, 400})
    for (const int grid : {0, 4, 8}) {
      SCOPED_TRACE(testing::Message() << count << " copies, grid " << grid);
      View view = front_view(9, 7);
      view.samples = grid == 0 ? 4 : 1;
      expect_brute_force(copies_of_a_leaf(count), view, {grid});
    }
}

TEST(LongLists, OfSheetsThatCrossEqualBruteForce) {
  for (const int count : {120, 500})
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      SCOPED_TRACE(testing::Message() << count << " sheets, seed " << seed);
      expect_brute_force(scene_of(random_mesh(Kind::sheets, count, seed)), front_view(7, 6), {4});
    }
}

// Comparing every pair of 100,000 copies in a pixel would take half an hour. All copies are blue.
TEST(LongLists, OfAHundredThousandCopiesAreComposited) {
  const Scene scene = painted(copies_of_a_leaf(tries_little ? 2'000 : 100'000), faint_colors(100));
  const glm::vec4 middle = pixel_of(flat_picture(Surfaces(scene), front_view(4, 4), {4}), 2, 2);
  EXPECT_NEAR(middle.a, 1, 1e-4);
  EXPECT_NEAR(middle.b, 0.5, 1e-3);
}

}  // namespace
}  // namespace frontmost::test
