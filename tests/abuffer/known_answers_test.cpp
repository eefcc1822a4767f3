// SPDX-License-Identifier: Apache-2.0
// Pixels whose fragments, masks and colours can be worked out on paper.

#include <gmock/gmock.h>

#include "support/flat_picture.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;

/// A view where one unit is one pixel: world (x, -y) is x pixels from the left and y from the top. Keys are (5 + z) /
/// 8.
View pixel_view(int width, int height) {
  View view;
  view.width = width;
  view.height = height;
  view.world_from_eye = look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(0, width, -height, 0, {1, 9});
  return view;
}

/// A triangle much larger than any picture here, whose plane has z = `middle` at x = 0.5 and rises by `slope` a pixel.
void add_plane(Mesh& mesh, float middle, float slope) {
  const auto corner = [&](float x, float y) { return glm::vec3(x, y, middle + slope * (x - 0.5f)); };
  add_triangle(mesh, corner(-16, -48), corner(48, -48), corner(-16, 48));
}

/// A surface at depth z that covers everything left of x = `edge`, in pixels.
void add_left_of(Mesh& mesh, float edge, float z) {
  add_triangle(mesh, {edge, -64, z}, {edge, 64, z}, {edge - 96, 0, z});
}

/// Pixels of triangles in these colours, from the picture and from the composited fragments, which must agree.
class Answers {
 public:
  Answers(const Mesh& mesh, std::vector<glm::vec4> colors)
      : colors_(std::move(colors)), scene_(painted(scene_of(mesh), colors_)), surfaces_(scene_) {}

  void draw(const View& view, const AbufferOptions& options) {
    picture_ = flat_picture(surfaces_, view, options);
    lists_ = abuffer(surfaces_, view, options);
  }
  [[nodiscard]] glm::vec4 at(int x, int y) const {
    const glm::vec4 found = pixel_of(picture_, x, y), by_fragments(laid_over(lists_, x, y, colors_));
    EXPECT_EQ(found, by_fragments) << x << ", " << y;
    return found;
  }

 private:
  std::vector<glm::vec4> colors_;
  Scene scene_;
  Surfaces surfaces_;
  Image picture_;
  FragmentLists lists_;
};

TEST(KnownAnswers, SubSamplesOfGridsAreTheMiddlesOfTheirCells) {
  const Scene scene = scene_of(Mesh());
  const Surfaces surfaces(scene);
  const auto samples = [&](int grid) { return abuffer(surfaces, pixel_view(2, 2), {grid}).samples; };
  EXPECT_THAT(samples(0), ElementsAre(glm::ivec2(128, 128)));
  EXPECT_THAT(samples(2),
              ElementsAre(glm::ivec2(64, 64), glm::ivec2(192, 64), glm::ivec2(64, 192), glm::ivec2(192, 192)));
  const std::vector<glm::ivec2> eight = samples(8);
  ASSERT_EQ(eight.size(), 64u);
  for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(eight[i], glm::ivec2(16 + 32 * int(i % 8), 16 + 32 * int(i / 8)));
}

TEST(KnownAnswers, MasksOfAnUprightEdge) {
  Mesh mesh;
  add_left_of(mesh, 3.5f, 0);
  const Scene scene = scene_of(std::move(mesh));
  const Surfaces surfaces(scene);
  const auto mask = [&](int grid, int x) {
    const auto list = abuffer(surfaces, pixel_view(6, 6), {grid, 0.5f});
    return list.at(x, 2).empty() ? 0 : list.at(x, 2)[0].mask;
  };
  // Bit 0 is the top left sub-sample; the left half of every row is covered.
  EXPECT_EQ(mask(2, 3), 0b0101u);
  EXPECT_EQ(mask(4, 3), 0x3333u);
  EXPECT_EQ(mask(8, 3), 0x0F0F0F0F0F0F0F0Fu);
  for (const int grid : {2, 4, 8}) {
    EXPECT_EQ(mask(grid, 2), grid == 8 ? ~std::uint64_t(0) : (std::uint64_t(1) << (grid * grid)) - 1);
    EXPECT_EQ(mask(grid, 4), 0u);
  }
  // The pixel's only sample lies on the edge, which is a right edge: not covered.
  EXPECT_EQ(mask(0, 3), 0u);
  EXPECT_EQ(mask(0, 2), 1u);
}

// Two triangles that share a diagonal through the corners of pixels: sub-samples on it belong to one of them.
TEST(KnownAnswers, ADiagonalLeavesNoSubSampleOutAndTakesNoneTwice) {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {0, -8, 0}, {8, -8, 0});
  add_triangle(mesh, {0, 0, 0}, {8, -8, 0}, {8, 0, 0});
  const Scene scene = scene_of(std::move(mesh));
  const Surfaces surfaces(scene);
  for (const int grid : {2, 4, 8}) {
    const FragmentLists lists = abuffer(surfaces, pixel_view(8, 8), {grid, 0.5f});
    for (int i = 0; i < 8; ++i) {
      const auto list = lists.at(i, i);
      ASSERT_EQ(list.size(), 2u);
      EXPECT_EQ(list[0].mask & list[1].mask, 0u);
      const int samples = grid * grid, upper = __builtin_popcountll(list[list[0].primitive == 1 ? 0 : 1].mask);
      EXPECT_EQ(__builtin_popcountll(list[0].mask | list[1].mask), samples);
      // The diagonal's own sub-samples, as many as a row has, go to the upper right triangle, as it is a left edge
      // there.
      EXPECT_EQ(upper, (samples + grid) / 2) << "grid " << grid;
    }
  }
}

TEST(KnownAnswers, GlassOverGlassOverNothing) {
  Mesh mesh;
  add_plane(mesh, 1, 0);
  add_plane(mesh, 0, 0);
  Answers glass(mesh, {{1, 0, 0, 0.5f}, {0, 0, 1, 0.5f}});
  for (const int grid : {0, 2, 4, 8}) {
    SCOPED_TRACE(testing::Message() << "grid " << grid);
    glass.draw(pixel_view(5, 3), {grid});
    // Half red, and half of blue through the remaining half.
    EXPECT_EQ(glass.at(2, 1), glm::vec4(0.5f, 0, 0.25f, 0.75f));
    glass.draw(pixel_view(5, 3), {grid, 0.5f});
    EXPECT_EQ(glass.at(2, 1), glm::vec4(0.25f, 0, 0.1875f, 0.4375f));
    glass.draw(pixel_view(5, 3), {grid, 0});
    EXPECT_EQ(glass.at(2, 1), glm::vec4(0));
  }
}

// Carpenter's intersecting fragments: two planes that cross in the middle of a pixel, each in front of half of it.
TEST(KnownAnswers, CrossingPlanesShareThePixelInWhichTheyCross) {
  Mesh mesh;
  add_plane(mesh, 0, 1.0f / 64);
  add_plane(mesh, 0, -1.0f / 64);
  Answers solid(mesh, {{1, 0, 0, 1}, {0, 0, 1, 1}}), glass(mesh, {{1, 0, 0, 0.5f}, {0, 0, 1, 0.5f}});
  for (const int grid : {2, 4, 8}) {
    SCOPED_TRACE(testing::Message() << "grid " << grid);
    solid.draw(pixel_view(4, 4), {grid});
    EXPECT_EQ(solid.at(0, 2), glm::vec4(0.5f, 0, 0.5f, 1));
    EXPECT_EQ(solid.at(1, 2), glm::vec4(1, 0, 0, 1)) << "red is nearer to the right";
    glass.draw(pixel_view(4, 4), {grid});
    // Half opacity in front leaves 1/4 behind, each for half of the pixel.
    EXPECT_EQ(glass.at(0, 2), glm::vec4(0.375f, 0, 0.375f, 0.75f));
    EXPECT_EQ(glass.at(3, 2), glm::vec4(0.5f, 0, 0.25f, 0.75f));
  }
}

TEST(KnownAnswers, KeysAndSlopesOfAPlane) {
  Mesh mesh;
  add_plane(mesh, 0, 1.0f / 16);
  const Scene scene = scene_of(std::move(mesh));
  const FragmentLists lists = abuffer(Surfaces(scene), pixel_view(8, 4), {4, 0.5f});
  for (int x = 0; x < 8; ++x) {
    const auto list = lists.at(x, 3);
    ASSERT_EQ(list.size(), 1u);
    EXPECT_FLOAT_EQ(list[0].key, (5 + float(x) / 16) / 8);
    EXPECT_FLOAT_EQ(list[0].key_dx, 1.0f / 128);
    EXPECT_NEAR(list[0].key_dy, 0, 1e-9);
    EXPECT_EQ(list[0].opacity, 0.5f);
  }
}

TEST(KnownAnswers, EqualKeysGoToTheLowerId) {
  Mesh mesh;
  for (int i = 0; i < 5; ++i) add_plane(mesh, 0.25f, 0);
  const Scene scene = scene_of(std::move(mesh));
  const Surfaces surfaces(scene);
  for (const int grid : {0, 8}) {
    const FragmentLists lists = abuffer(surfaces, pixel_view(3, 3), {grid, 0.5f});
    const auto list = lists.at(1, 1);
    ASSERT_EQ(list.size(), 5u);
    for (PrimitiveId id = 0; id < 5; ++id) EXPECT_EQ(list[id].primitive, id);
  }
  const std::vector<Visible> layers = visible_layers(surfaces, pixel_view(3, 3), 5, {0, 0.5f});
  for (PrimitiveId id = 0; id < 5; ++id) EXPECT_EQ(layers[id].primitives[4], id);
}

TEST(KnownAnswers, CullingLeavesFragmentsOut) {
  Mesh mesh;
  add_plane(mesh, 1, 0);  // counter-clockwise to the eye
  add_plane(mesh, 0, 0);
  std::swap(mesh.triangles[1].y, mesh.triangles[1].z);
  const Scene scene = scene_of(std::move(mesh));
  const Surfaces surfaces(scene);
  const auto seen = [&](Culling culling) {
    View view = pixel_view(3, 3);
    view.culling = culling;
    std::vector<PrimitiveId> ids;
    const FragmentLists lists = abuffer(surfaces, view, {2, 0.5f});
    for (const Fragment& f : lists.at(1, 1)) ids.push_back(f.primitive);
    return ids;
  };
  EXPECT_THAT(seen(Culling::none), ElementsAre(0, 1));
  EXPECT_THAT(seen(Culling::back), ElementsAre(0));
  EXPECT_THAT(seen(Culling::front), ElementsAre(1));
  EXPECT_THAT(seen(Culling::both), ElementsAre());
}

TEST(KnownAnswers, OpacitiesComeFromMaterials) {
  Mesh mesh;
  for (int i = 0; i < 6; ++i) add_plane(mesh, 1 - 0.25f * float(i), 0);
  mesh.material_ids = {0, 1, 2, 3, no_index, 4};
  Scene scene = scene_of(std::move(mesh));
  const float alphas[] = {0.25f, 0, -3, std::numeric_limits<float>::quiet_NaN(), 7};
  for (const float alpha : alphas) {
    Material material;
    material.alpha = Material::Alpha::blend;
    material.base_color.a = alpha;
    scene.materials.push_back(material);
  }
  std::vector<float> opacities;
  const FragmentLists lists = abuffer(Surfaces(scene), pixel_view(2, 2), {4, 0.5f});
  for (const Fragment& f : lists.at(1, 1)) opacities.push_back(f.opacity);
  // Values out of range are clamped, NaN becomes 0, and triangles without a material take the opacity of the options.
  EXPECT_THAT(opacities, ElementsAre(0.125f, 0.0f, 0.0f, 0.0f, 0.5f, 0.5f));
}

TEST(KnownAnswers, OnlyWhatCoversTheWholePixelCutsOff) {
  Mesh mesh;
  add_left_of(mesh, 3.5f, 1);  // opaque, in front of half of pixel 3
  add_plane(mesh, 0, 0);
  const Scene scene = scene_of(std::move(mesh));
  const FragmentLists lists = abuffer(Surfaces(scene), pixel_view(6, 6), {8});
  const auto ids = [&](int x) {
    std::vector<PrimitiveId> list;
    for (const Fragment& f : lists.at(x, 3)) list.push_back(f.primitive);
    return list;
  };
  EXPECT_THAT(ids(2), ElementsAre(0));
  EXPECT_THAT(ids(3), ElementsAre(0, 1));
  EXPECT_THAT(ids(4), ElementsAre(1));
}

// Triangles that are not finite, have no area, or lie behind the eye have no fragments; the ids of other triangles
// stay.
TEST(KnownAnswers, TrianglesThatAreNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  Mesh mesh;
  add_triangle(mesh, {nan, 0, 0}, {9, -9, 0}, {9, 9, 0});
  add_triangle(mesh, {-9, -9, 0}, {infinity, 0, 0}, {9, 9, 0});
  add_triangle(mesh, {-9, -9, 0}, {9, -9, 0}, {9, -9, 0});
  add_triangle(mesh, {-9, -9, 6}, {48, -9, 6}, {-9, 48, 6});
  add_triangle(mesh, {-9, -9, -6}, {48, -9, -6}, {-9, 48, -6});
  add_plane(mesh, 0, 0);
  const Scene scene = scene_of(std::move(mesh));
  for (const int grid : {0, 4}) {
    const FragmentLists lists = abuffer(Surfaces(scene), pixel_view(4, 4), {grid, 0.5f});
    EXPECT_EQ(lists.fragments.size(), 16u);
    for (const Fragment& f : lists.fragments) EXPECT_EQ(f.primitive, 5u);
  }
}

TEST(KnownAnswers, AnEmptySceneHasEmptyLists) {
  const Scene scene = scene_of(Mesh());
  const Surfaces surfaces(scene);
  const View view = pixel_view(70, 3);
  const FragmentLists lists = abuffer(surfaces, view, {4});
  EXPECT_TRUE(lists.fragments.empty());
  ASSERT_EQ(lists.first.size(), view.pixel_count() + 1);
  for (const std::uint64_t first : lists.first) EXPECT_EQ(first, 0u);
  const FragmentCounts counts = count_fragments(surfaces, view);
  EXPECT_EQ(counts.fragments, 0u);
  EXPECT_EQ(counts.longest, 0u);
  const Image picture = flat_picture(surfaces, view);
  for (std::size_t i = 0; i < view.pixel_count(); ++i) EXPECT_EQ(pixel_of(picture, i), glm::vec4(0));
}

}  // namespace
}  // namespace frontmost::test
