// SPDX-License-Identifier: Apache-2.0
// Many layers, with opaque ones among them, and values that are refused.

#include <gtest/gtest.h>

#include <functional>

#include "fragment_oracle.h"
#include "support/effort.h"
#include "support/flat_picture.h"
#include "support/random_scene.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

/// Sheets one behind the other, nearest first, each of two triangles.
Scene stack_of(int count) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const float z = -float(i) / float(count);
    add_triangle(mesh, {-2, -2, z}, {2, -2, z}, {2, 2, z});
    add_triangle(mesh, {-2, -2, z}, {2, 2, z}, {-2, 2, z});
  }
  return scene_of(std::move(mesh));
}

TEST(ManyLayers, TilesInPartsGiveWhatEverySheetAddsUpTo) {
  constexpr int count = 700;  // 2.8 million fragments in a tile of 64 x 64, ten times the number kept at once
  const View view = front_view(70, 66);
  Random random(1);
  std::vector<glm::vec4> colors;
  double left = 1, red = 0;
  for (int i = 0; i < count; ++i) {
    const glm::vec4 color(random.unit(), 0, 0, 0.004f);
    colors.insert(colors.end(), {color, color});
    red += left * double(color.a) * double(color.r);
    left *= 1 - double(color.a);
  }
  const Scene scene = painted(stack_of(count), colors);
  const Surfaces surfaces(scene);
  for (const int grid : {0, 4}) {
    const Image picture = flat_picture(surfaces, view, {grid});
    for (std::size_t i = 0; i < view.pixel_count(); ++i) {
      ASSERT_NEAR(pixel_of(picture, i).r, red, 1e-5) << "pixel " << i;
      ASSERT_NEAR(pixel_of(picture, i).a, 1 - left, 1e-5) << "pixel " << i;
    }
  }
}

TEST(ManyLayers, APixelOfThousandsIsSortedAlone) {
  constexpr int count = 20'000;
  const Scene scene = stack_of(count);
  const Surfaces surfaces(scene);
  const std::vector<Visible> layers = visible_layers(surfaces, front_view(5, 3), 1024, {0, 0.5f});
  // Sheets a twenty-thousandth apart have distinct keys, and each shows one of its two triangles.
  for (std::size_t k = 0; k < layers.size(); ++k)
    for (std::size_t i = 0; i < 15; ++i) ASSERT_EQ(layers[k].primitives[i] / 2, k) << "pixel " << i;
}

// One fragment more than a 20-bit rank can number is an error before anything is sorted.
TEST(ManyLayers, APixelHasOnlySoManyFragments) {
  Scene scene = stack_of(1);
  Mesh& mesh = scene.meshes[0];
  mesh.triangles.assign(std::size_t(1) << 20, glm::uvec3(0, 1, 2));
  View view = front_view(1, 1);
  view.world_from_eye = look_at({0.5, -0.5, 1}, {0.5, -0.5, 0}, {0, 1, 0});  // in the middle of the triangles
  try {
    (void)count_fragments(Surfaces(scene), view);
    FAIL() << "no limit";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
    EXPECT_STREQ(error.what(), "abuffer: more than 1,048,575 fragments in one pixel");
  }
  if (tries_little) return;  // the longest list takes a second to sort
  mesh.triangles.pop_back();
  EXPECT_EQ(count_fragments(Surfaces(scene), view).longest, (1u << 20) - 1);
}

TEST(Counts, AreThoseOfTheListsOfTranslucentThings) {
  const View view = front_view(130, 70);
  for (const Kind kind : all_kinds) {
    const Scene scene = scene_of(random_mesh(kind, 40, 3));
    const Surfaces surfaces(scene);
    for (const int grid : {0, 4}) {
      const FragmentLists lists = abuffer(surfaces, view, {grid, 0.5f});
      std::size_t longest = 0;
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) longest = std::max(longest, lists.at(x, y).size());
      const FragmentCounts counts = count_fragments(surfaces, view, {grid});
      EXPECT_EQ(counts.fragments, lists.fragments.size());
      EXPECT_EQ(counts.longest, longest);
    }
  }
  // The result is the same in parts: 700 sheets are more than a tile holds at once.
  const Scene many = stack_of(700);
  const FragmentCounts counts = count_fragments(Surfaces(many), front_view(70, 66), {});
  EXPECT_EQ(counts.fragments, 700u * 70 * 66);
  EXPECT_EQ(counts.longest, 700u);
}

TEST(Opaque, SheetsCutOffWhatIsBehind) {
  Scene scene = stack_of(10);
  Material glass, wall;
  glass.alpha = Material::Alpha::blend;
  glass.base_color.a = 0.25f;
  scene.materials = {glass, wall};
  scene.meshes[0].material_ids.assign(20, 0);
  scene.meshes[0].material_ids[6] = scene.meshes[0].material_ids[7] = 1;  // the fourth sheet
  const Surfaces surfaces(scene);
  for (const int grid : {0, 8}) {
    const FragmentLists lists = abuffer(surfaces, front_view(40, 30), {grid});
    const auto list = lists.at(30, 10);
    ASSERT_EQ(list.size(), 4u);
    EXPECT_EQ(list[0].opacity, 0.25f);
    EXPECT_EQ(list[3].opacity, 1.0f);
    EXPECT_EQ(list[3].primitive / 2, 3u);
    // With everything translucent, no layer is cut off.
    EXPECT_EQ(abuffer(surfaces, front_view(40, 30), {grid, 0.5f}).at(30, 10).size(), 10u);
  }
  const std::vector<Visible> layers = visible_layers(surfaces, front_view(40, 30), 6);
  const std::size_t at = layers[0].index(30, 10);
  EXPECT_EQ(layers[3].primitives[at] / 2, 3u);
  EXPECT_EQ(layers[4].primitives[at], no_primitive);
  EXPECT_EQ(layers[4].keys[at], 0.0f);
}

TEST(Slopes, TellTheKeyElsewhereInThePixel) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 400, 9));
  const Surfaces surfaces(scene);
  Random random(4);
  const View view = random_view(random, 80, 60);
  const FragmentLists lists = abuffer(surfaces, view, {8, 0.5f});
  std::size_t compared = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x + 1 < view.width; ++x)
      for (const Fragment& a : lists.at(x, y))
        for (const Fragment& b : lists.at(x + 1, y)) {
          if (a.primitive != b.primitive || a.mask != ~std::uint64_t(0) || b.mask != ~std::uint64_t(0)) continue;
          ASSERT_NEAR(a.key + a.key_dx, b.key, 1e-5);
          ++compared;
        }
  EXPECT_GT(compared, 2000u);
}

TEST(Values, OutOfRangeAreRefused) {
  const Scene scene = stack_of(1);
  const Surfaces surfaces(scene);
  const View view = front_view(8, 8);
  for (const int grid : {-1, 1, 3, 16})
    EXPECT_EQ(code_of([&] { (void)abuffer(surfaces, view, {grid}); }), ErrorCode::bad_argument);
  for (const float opacity : {-0.1f, 1.1f, std::numeric_limits<float>::quiet_NaN()})
    for (const auto& action :
         std::initializer_list<std::function<void()>>{[&] {
                                                        (void)abuffer(surfaces, view, {0, opacity});
                                                      },
                                                      [&] {
                                                        (void)count_fragments(surfaces, view, {0, opacity});
                                                      },
                                                      [&] {
                                                        (void)visible_layers(surfaces, view, 1, {0, opacity});
                                                      },
                                                      [&] {
                                                        (void)flat_picture(surfaces, view, {0, opacity});
                                                      }})
      EXPECT_EQ(code_of(action), ErrorCode::bad_argument);
  EXPECT_EQ(code_of([&] { (void)visible_layers(surfaces, view, 0); }), ErrorCode::bad_argument);
  EXPECT_EQ(code_of([&] { (void)visible_layers(surfaces, view, 1025); }), ErrorCode::bad_argument);
}

/// A view where one unit of x and y is one pixel, and pixel (x, y) of the crop is pixel (left + x, top + y) of the
/// whole.
View crop(int left, int top, int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  view.world_from_eye = look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(left, left + width, -top - height, -top, {1, 9});
  return view;
}

TEST(LargePictures, EqualTheirParts) {
  // Vertices are on multiples of 1/4 pixel, so that both views round them alike.
  Random random(7);
  Mesh mesh;
  for (int i = 0; i < 500; ++i) {
    glm::vec3 corners[3];
    const float x = 0.25f * float(random.below(4096)), y = -0.25f * float(random.below(2048));
    for (glm::vec3& corner : corners) {
      const float dx = float(random.below(200)), dy = float(random.below(200));
      corner = {x + dx, y + dy, random.within(-2, 2)};
    }
    add_triangle(mesh, corners[0], corners[1], corners[2]);
  }
  const std::vector<glm::vec4> blue = {{0.2f, 0.4f, 0.9f, 0.3f}};
  const Scene scene = painted(scene_of(std::move(mesh)), blue);
  const Surfaces surfaces(scene);
  // The last tile of a row is 64, 44 or 41 pixels wide: whole groups of pixels, and a group with a single column.
  constexpr int height = 512, step = 128;
  for (const int width : {1024, 1004, 1001})
    for (const int grid : {0, 2}) {
      const Image whole = flat_picture(surfaces, crop(0, 0, width, height), {grid});
      for (int top = 0; top < height; top += step) {
        const Image part = flat_picture(surfaces, crop(0, top, width, step), {grid});
        for (std::size_t i = 0; i < std::size_t(width * step); ++i) {
          const std::size_t at = std::size_t(top) * std::size_t(width) + i;
          ASSERT_EQ(pixel_of(part, i), pixel_of(whole, at)) << width << ": " << at;
        }
      }
    }
}

}  // namespace
}  // namespace frontmost::test
