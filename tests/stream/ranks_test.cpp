// SPDX-License-Identifier: Apache-2.0
// Ranks that stream a model together give the picture of the whole model to the bit, whichever rank reads which part.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "frontmost/streams.h"
#include "stream/as_whole.h"
#include "stream/shared.h"
#include "stream/thread_ranks.h"
#include "support/meshes.h"

namespace frontmost::test {
namespace {

class RanksTest : public StreamFiles {
 protected:
  void expect_same_of_ranks(const std::vector<std::string>& paths, const std::vector<int>& readers,
                            std::uint32_t at_once) {
    for (const int count : {1, 2, 3, 8}) {
      SCOPED_TRACE(testing::Message() << count << " ranks, " << readers.size() << " readers");
      on_ranks(count, [&](Ranks& ranks) {
        StreamOptions options{.load = {}, .triangles_at_once = at_once, .ranks = &ranks, .readers = readers};
        for (int& reader : options.readers) reader = reader < 0 ? reader : reader % count;
        Stream stream(paths, options);
        expect_as_whole(stream, paths, ranks.number() == 0);
      });
    }
  }
};

TEST_F(RanksTest, OneFileInTurns) {
  std::uint64_t seed = 0;
  for (const Kind kind : all_kinds) {
    const Mesh mesh = random_mesh(kind, 150, ++seed);
    expect_same_of_ranks({file("a.stl", stl_of(mesh))}, {}, 7);
    expect_same_of_ranks({file("b.ply", ply_of(mesh))}, {}, 7);
  }
}

TEST_F(RanksTest, FilesOfTheirOwn) {
  std::vector<std::string> paths;
  for (int i = 0; i < 8; ++i) {
    const Mesh mesh = random_mesh(i % 2 ? Kind::soup : Kind::coplanar, 40 + 10 * i, std::uint64_t(i) % 3);
    paths.push_back(file("part" + std::to_string(i) + (i % 3 ? ".stl" : ".ply"), i % 3 ? stl_of(mesh) : ply_of(mesh)));
  }
  expect_same_of_ranks(paths, {0, 1, 2, 3, 4, 5, 6, 7}, 1u << 19);
  expect_same_of_ranks(paths, {3, 0, 2, 1, 1, 7, 0, 5}, 13);
}

TEST_F(RanksTest, SomeOfTheirOwnSomeShared) {
  const std::string a = file("a.stl", stl_of(random_mesh(Kind::soup, 200, 1)));
  const std::string empty = file("empty.stl", stl_of({}));
  const std::string b = file("b.ply", ply_of(random_mesh(Kind::shared_grid, 300, 2)));
  expect_same_of_ranks({a, empty, b, a}, {0, 1, -1, 1}, 11);
  expect_same_of_ranks({empty, b, empty}, {0, 1, 2}, 11);
  expect_same_of_ranks({a, b}, {-1, -1}, 50);
}

TEST_F(RanksTest, SmoothNormalsReachAcrossRanks) {
  const Mesh mesh = builtin("teapot").meshes[0];
  expect_same_of_ranks({file("pot.ply", ply_of(mesh))}, {}, 97);
  Mesh halves[2] = {mesh, mesh};
  const auto middle = std::ptrdiff_t(mesh.triangles.size() / 2);
  halves[0].triangles.resize(std::size_t(middle));
  halves[1].triangles.erase(halves[1].triangles.begin(), halves[1].triangles.begin() + middle);
  expect_same_of_ranks({file("half1.stl", stl_of(halves[0])), file("half2.stl", stl_of(halves[1]))}, {0, 1}, 97);
}

// The camera is given, so during the first pass no rank knows yet how many triangles the others have.
TEST_F(RanksTest, IdsAreThoseOfTheWholeFromTheFirstPassOn) {
  std::vector<std::string> paths;
  for (int i = 0; i < 3; ++i)
    paths.push_back(file(std::to_string(i) + ".ply", ply_of(random_mesh(Kind::soup, 100 + i, std::uint64_t(i)))));
  const Scene scene = loaded(paths);
  const View view = frame(Surfaces(scene), 80, 60);
  const std::uint64_t hash = content_hash(zbuffer(Surfaces(scene), view));
  on_ranks(3, [&](Ranks& ranks) {
    Stream stream(paths, {.load = {}, .ranks = &ranks, .readers = {2, 0, 1}});
    for (int pass = 1; pass <= 2; ++pass) {
      const Excerpt excerpt = stream.look({view});
      EXPECT_EQ(stream.passes(), pass);
      EXPECT_EQ(stream.triangle_count(), 303u);
      EXPECT_EQ(stream.bounds().low, Surfaces(scene).bounds().low);
      if (ranks.number() > 0) continue;
      EXPECT_EQ(content_hash(excerpt.in_stream(excerpt.visible[0])), hash);
    }
  });
}

TEST_F(RanksTest, WarningsAreToldOnceInTheOrderOfFiles) {
  const std::string none = file("none.ply", ply_of({})), some = file("some.ply", ply_of(random_mesh(Kind::soup, 9, 1)));
  const std::vector<std::string> paths = {none, some, none};
  Stream alone(paths);
  const Scene scene = loaded(paths);
  const View view = frame(Surfaces(scene), 20, 20);
  (void)alone.look({view});
  ASSERT_EQ(alone.scene().warnings.size(), 2u);
  for (const std::vector<int>& readers : {std::vector<int>{1, 0, 0}, std::vector<int>{-1, 1, 1}, std::vector<int>{}})
    on_ranks(2, [&](Ranks& ranks) {
      Stream stream(paths, {.load = {}, .ranks = &ranks, .readers = readers});
      (void)stream.look({view});
      (void)stream.look({view});
      EXPECT_EQ(stream.scene().warnings, alone.scene().warnings);
    });
}

TEST_F(RanksTest, PipesAndStandardInputAreRefused) {
  const std::string pipe = folder_.file("pipe.stl");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("-")})
    on_ranks(2, [&](Ranks& ranks) {
      try {
        const Stream stream({path}, {.load = {}, .ranks = &ranks});
        ADD_FAILURE();
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::unsupported);
        EXPECT_THAT(error.what(), testing::HasSubstr("several ranks can read only ordinary files"));
      }
    });
}

// Ranks see different files under the same names.
TEST(Messages, ThatDoNotFitAreErrors) {
  streaming::MessageWriter writer;
  writer.put_list(std::string("twelve bytes"));
  const Ranks::Message message = writer.take();
  streaming::MessageReader reader(message), again(message), beyond(message);
  EXPECT_EQ(reader.get_list<std::string>(), "twelve bytes");
  EXPECT_TRUE(reader.is_at_end());
  EXPECT_THROW((void)reader.get<int>(), Error);
  EXPECT_THROW((void)again.get_list<std::vector<glm::vec3>>(), Error) << "twelve points";
  using Longer = std::array<char, 21>;
  EXPECT_THROW((void)beyond.get<Longer>(), Error);
}

TEST(IdShift, LeadsFromTheIdsOfAPassToThoseOfTheWhole) {
  const streaming::IdShift shift({0, 0, 10, 10}, {0, 10, 0, 5}, {0, 7, 17, 100});
  EXPECT_EQ(shift(0), 7u);
  EXPECT_EQ(shift(9), 16u);
  EXPECT_EQ(shift(10), 100u);
  std::vector<PrimitiveId> ids = {9, no_primitive, 14};
  shift.apply(ids, {});
  EXPECT_THAT(ids, testing::ElementsAre(16, no_primitive, 104));
}

}  // namespace
}  // namespace frontmost::test
