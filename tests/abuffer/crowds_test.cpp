// SPDX-License-Identifier: Apache-2.0
// Long lists: the same triangles again and again, and sheets that cross.

#include <gtest/gtest.h>

#include "fragment_oracle.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

View front_view(int width, int height) {
  return make_view(0.9, width, height).looking({0, 0, 1}, {0, 0, 0}, {0, 1, 0}).between(0.5, 6);
}

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
  const Surfaces surfaces(scene);
  const std::vector<glm::vec4> colors = faint_colors(surfaces.primitive_count());
  const ResolvedPicture picture = resolve(surfaces, view, colors, options, {.isa = Isa::best});
  const auto triangles = screen_triangles(surfaces, view);
  const auto samples = oracle_samples(view, options.grid);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const glm::dvec4 wanted = oracle_pixel(oracle_fragments(triangles, samples, x, y), samples, x, y, colors, 1);
      const std::size_t at = std::size_t(y) * std::size_t(view.width) + std::size_t(x);
      const glm::dvec4 found(picture.red[at], picture.green[at], picture.blue[at], picture.alpha[at]);
      for (int k = 0; k < 4; ++k) ASSERT_NEAR(found[k], wanted[k], 3e-5) << x << ", " << y << ", channel " << k;
    }
  for (const Isa isa : available_isas()) {
    const ResolvedPicture other = resolve(surfaces, view, colors, options, {.isa = isa});
    for (std::size_t i = 0; i < view.pixel_count(); ++i) {
      ASSERT_EQ(picture.red[i], other.red[i]) << std::string(name(isa)) << ", pixel " << i;
      ASSERT_EQ(picture.alpha[i], other.alpha[i]) << std::string(name(isa)) << ", pixel " << i;
    }
  }
}

// Lists of 100 are gone through sixteen pixels at a time, those of 400 pixel by pixel. Where the shared edge crosses a
// pixel, copies of one side are held against those of the other in vain: of 400 these are more pairs than are looked
// at.
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

// Every pair of copies in a pixel was looked at: 100,000 then take half an hour. Blue is what all of them have.
TEST(LongLists, OfAHundredThousandCopiesAreComposited) {
  const Scene scene = copies_of_a_leaf(under_sanitizer ? 2'000 : 100'000);
  const Surfaces surfaces(scene);
  const std::vector<glm::vec4> colors = faint_colors(surfaces.primitive_count());
  const View view = front_view(8, 8);
  const ResolvedPicture picture = resolve(surfaces, view, colors, {4});
  const std::size_t middle = std::size_t(view.width) * 4 + 4;
  EXPECT_NEAR(picture.alpha[middle], 1, 1e-4);
  EXPECT_NEAR(picture.blue[middle], 0.5, 1e-3);
}

}  // namespace
}  // namespace frontmost::test
