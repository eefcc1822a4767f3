// SPDX-License-Identifier: Apache-2.0
// Parts of streams, each by itself: which triangles may be visible, which touch others, and where they are stored.
#include <gmock/gmock.h>

#include <cmath>

#include "frontmost/zbuffer.h"
#include "stream/as_whole.h"
#include "stream/neighbours.h"
#include "stream/outline.h"
#include "stream/sample_filter.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace streaming;
using testing::ElementsAre;

TEST(IdMap, FindsThePlacesOfAllHoweverTheyAreSpread) {
  const std::vector<std::vector<PrimitiveId>> lists = {
      {0}, {no_primitive - 1}, {0, no_primitive - 1}, {5, 6, 7, 8}, {0, 1, 2, 1'000'000, 4'000'000'000u}};
  for (const std::vector<PrimitiveId>& ids : lists) {
    const IdMap map(ids);
    for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(map.place_of(ids[i]), i) << ids[i];
  }
  Random random(2);
  std::vector<PrimitiveId> ids;
  for (PrimitiveId id = 0; ids.size() < 20'000; id += 1 + PrimitiveId(random.below(random.below(50) ? 5 : 100'000)))
    ids.push_back(id);
  const IdMap map(ids);
  for (std::size_t i = 0; i < ids.size(); ++i) ASSERT_EQ(map.place_of(ids[i]), i);
}

TEST(IdMap, ReplacesTheIdsOfAPictureAndLeavesNothingAlone) {
  Visible visible;
  visible.primitives = Buffer<PrimitiveId>(200'000);
  const std::vector<PrimitiveId> ids = {3, 40, 500, 6000};
  for (std::size_t i = 0; i < visible.primitives.size(); ++i)
    visible.primitives[i] = i % 5 == 4 ? no_primitive : ids[i % 5];
  IdMap(ids).apply({visible.primitives.data(), visible.primitives.size()}, {.threads = 2});
  for (std::size_t i = 0; i < visible.primitives.size(); ++i)
    ASSERT_EQ(visible.primitives[i], i % 5 == 4 ? no_primitive : PrimitiveId(i % 5)) << i;
}

TEST(IdMap, KnowsNoOtherIds) {
  const std::vector<PrimitiveId> ids = {3, 40, 500, 6000};
  const IdMap map(ids);
  for (const PrimitiveId other : {0u, 4u, 39u, 499u, 501u, 6001u, 4'000'000'000u})
    EXPECT_EQ(map.place_of(other), no_primitive) << other;
  const std::vector<PrimitiveId> none;
  EXPECT_EQ(IdMap(none).place_of(0), no_primitive);
}

TEST(TouchedPositions, ArePositionsToTheBitButForTheSignOfZero) {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(mesh, {-0.0f, -0.0f, -0.0f}, {5, 5, 5}, {6, 5, 5});
  add_triangle(mesh, {std::nextafter(1.0f, 2.0f), 0, 0}, {5, 5, 5}, {6, 5, 5});
  add_triangle(mesh, {5, 5, 5}, {6, 5, 5}, {1, 0, 0});
  TouchedPositions touched(3);
  touched.add({0, 0, 0});
  touched.add({1, 0, 0});
  touched.add({1, 0, 0});
  EXPECT_TRUE(touched.touches(mesh, 0));
  EXPECT_TRUE(touched.touches(mesh, 1));
  EXPECT_FALSE(touched.touches(mesh, 2)) << "a unit in the last place away";
  EXPECT_TRUE(touched.touches(mesh, 3));
}

TEST(TouchedPositions, FindAllOfManyAndNoOther) {
  Random random(5);
  std::vector<glm::vec3> in;
  for (int i = 0; i < 3000; ++i) in.push_back(random.point(1));
  TouchedPositions touched(in.size());
  for (const glm::vec3& p : in) touched.add(p);
  Mesh mesh;
  for (const glm::vec3& p : in) add_triangle(mesh, {9, 9, 9}, p, {8, 8, 8});
  for (std::uint32_t t = 0; t < 3000; ++t) ASSERT_TRUE(touched.touches(mesh, t)) << t;
  Mesh others;
  for (int i = 0; i < 3000; ++i) add_triangle(others, random.point(1), random.point(1), random.point(1));
  std::size_t found = 0;
  for (std::uint32_t t = 0; t < 3000; ++t) found += touched.touches(others, t);
  EXPECT_EQ(found, 0u) << "a filter may err, the slots behind it may not";
}

TEST(TouchedPositions, TellOnlyAThousandTrianglesAtOnePlace) {
  Mesh fan;
  for (int i = 0; i < 2000; ++i) add_triangle(fan, {0, 0, 0}, {1, float(i), 0}, {1, float(i + 1), 0});
  TouchedPositions touched(1);
  touched.add({0, 0, 0});
  std::size_t told = 0;
  for (std::uint32_t t = 0; t < 2000; ++t) told += touched.touches(fan, t);
  EXPECT_EQ(told, 1000u);
}

// The filter may let invisible triangles through; it must not lose a visible one, nor any of its pixels.
TEST(SampleFilter, LosesNothingThatTheZBufferShows) {
  std::size_t marked = 0, all = 0;
  for (const Kind kind : all_kinds)
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE(testing::Message() << int(kind) << ", seed " << seed);
      Random random(seed);
      const Scene scene = scene_of(random_mesh(kind, 200, seed));
      const int width = 1 + random.below(80), height = 1 + random.below(60);
      View view = random_view(random, width, height);
      view.samples = seed % 2 ? 4 : 1;
      const Mesh& mesh = scene.meshes[0];
      std::vector<std::uint8_t> marks(mesh.triangles.size(), 0);
      const PixelBounds pixels = SampleFilter(view).mark(mesh, marks);
      const Visible visible = zbuffer(Surfaces(scene), view);
      for (int s = 0; s < view.samples; ++s)
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) {
            const PrimitiveId id = visible.primitives[visible.index(x, y, s)];
            if (id == no_primitive) continue;
            ASSERT_EQ(marks[id], 1) << id;
            ASSERT_TRUE(x >= pixels.x0 && x < pixels.x1 && y >= pixels.y0 && y < pixels.y1) << x << ", " << y;
          }
      // The filter must reject most triangles smaller than the distance of samples.
      if (kind == Kind::tiny) {
        marked += std::size_t(std::count(marks.begin(), marks.end(), 1));
        all += marks.size();
      }
    }
  EXPECT_LT(marked, all / 2);
}

TEST(SampleFilter, LeavesOutWhatIsBehindTheEyeOrBesideThePicture) {
  View view;
  view.width = view.height = 16;
  view.projection = make_projection(1.0, 1, {1, 10});
  Mesh mesh;
  add_triangle(mesh, {-1, -1, -5}, {1, -1, -5}, {0, 1, -5});                             // visible
  add_triangle(mesh, {-1, -1, 5}, {1, -1, 5}, {0, 1, 5});                                // behind
  add_triangle(mesh, {-1, -1, -50}, {1, -1, -50}, {0, 1, -50});                          // beyond the far plane
  add_triangle(mesh, {90, -1, -5}, {95, -1, -5}, {92, 1, -5});                           // beside
  add_triangle(mesh, {0.001f, 0.001f, -9}, {0.002f, 0.001f, -9}, {0.001f, 0.002f, -9});  // between samples
  add_triangle(mesh, {-1, -1, 5}, {1, -1, -5}, {0, 1, -5});                              // through the near plane
  add_triangle(mesh, {std::nanf(""), 0, -5}, {1, -1, -5}, {0, 1, -5});                   // NaN: left to the reader
  std::vector<std::uint8_t> marks(7, 0);
  const PixelBounds pixels = SampleFilter(view).mark(mesh, marks);
  EXPECT_THAT(marks, ElementsAre(1, 0, 0, 0, 0, 1, 1));
  EXPECT_FALSE(pixels.is_empty());
}

TEST(PixelBounds, GrowByWhatIsNotEmpty) {
  PixelBounds bounds;
  EXPECT_TRUE(bounds.is_empty());
  bounds.include({5, 5, 5, 9});
  EXPECT_TRUE(bounds.is_empty()) << "no width";
  bounds.include({5, 6, 7, 9});
  bounds.include({1, 8, 2, 20});
  bounds.include({});
  EXPECT_THAT((std::array{bounds.x0, bounds.y0, bounds.x1, bounds.y1}), ElementsAre(1, 6, 7, 20));
}

TEST(KeptTriangles, KeepTheirAttributesAndNumbers) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
  mesh.triangles = {{0, 1, 2}, {3, 2, 1}, {0, 0, 0}};
  mesh.colors.values = {glm::vec4(0), glm::vec4(1), glm::vec4(2), glm::vec4(3)};
  mesh.texcoords.values = {{0.5f, 0.5f}};
  mesh.texcoords.triangles = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  mesh.material_ids = {4};
  Kept kept{{2, 100, 0}, {}, {}};
  for (const std::uint32_t t : {0u, 1u, 2u}) {
    kept.triangles.push_back(t);
    append_triangle(mesh, t, kept.mesh);
  }
  EXPECT_THAT(kept.mesh.triangles, ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(3, 4, 5), glm::uvec3(6, 7, 8)));
  EXPECT_EQ(kept.mesh.positions[3], glm::vec3(5));
  EXPECT_EQ(kept.mesh.colors.values[3], glm::vec4(3));
  EXPECT_EQ(kept.mesh.texcoords.values.size(), 9u);
  EXPECT_THAT(kept.mesh.material_ids, ElementsAre(4, 4, 4)) << "one for each";
  thin_out(kept, [](PrimitiveId id) { return id != 101; });
  EXPECT_THAT(kept.triangles, ElementsAre(0, 2));
  EXPECT_EQ(kept.mesh.positions.size(), 6u);
  EXPECT_EQ(kept.mesh.positions[1], glm::vec3(1, 0, 0));
  EXPECT_EQ(kept.mesh.positions[5], glm::vec3(0));
  thin_out(kept, [](PrimitiveId) { return false; });
  EXPECT_TRUE(kept.triangles.empty());
  EXPECT_TRUE(kept.mesh.positions.empty());
}

// Parts of a model, joined in any order, have the outline of the whole: framing is the same to the bit.
TEST(OutlineFinder, OfPartsIsThatOfTheWhole) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const Mesh mesh = random_mesh(seed % 2 ? Kind::soup : Kind::tiny, 400, seed);
    const View direction = random_view(random, 64, 48);
    OutlineFinder whole(direction, 0.05), parts(direction, 0.05);
    whole.include(mesh);
    for (const std::size_t begin : {std::size_t(300), std::size_t(0), std::size_t(100)}) {
      Mesh part = mesh;
      const std::size_t end = begin == 300 ? 400 : begin == 0 ? 100 : 300;
      part.triangles.assign(mesh.triangles.begin() + std::ptrdiff_t(begin),
                            mesh.triangles.begin() + std::ptrdiff_t(end));
      OutlineFinder one(direction, 0.05);
      one.include(part);
      parts.include(one.points());
    }
    EXPECT_EQ(parts.bounds().low, whole.bounds().low);
    EXPECT_EQ(parts.bounds().high, whole.bounds().high);
    const Scene of_parts = parts.scene(), of_whole = whole.scene(), model = scene_of(mesh);
    const View framed = frame(Surfaces(of_parts), 64, 48);
    EXPECT_EQ(framed.world_from_eye, frame(Surfaces(of_whole), 64, 48).world_from_eye);
    EXPECT_EQ(Surfaces(of_parts).bounds().low, Surfaces(model).bounds().low);
  }
}

TEST(RefusedStreams, SayWhatIsMissing) {
  const auto words = [](const auto& action) -> std::string {
    try {
      action();
      return "taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      return error.what();
    }
  };
  EXPECT_EQ(words([] { Stream stream(std::vector<std::string>{}); }), "stream: no files");
}

}  // namespace
}  // namespace frontmost::test
