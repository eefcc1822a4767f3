// SPDX-License-Identifier: Apache-2.0
// A stream gives the picture of the whole model to the bit, however small its pieces are.
#include <gmock/gmock.h>

#include "frontmost/streams.h"
#include "stream/as_whole.h"
#include "support/meshes.h"
#include "support/random_scene.h"

namespace frontmost {
namespace {

using test::expect_streams_as_whole;
using test::Kind;
using test::ply_of;
using test::put;
using test::stl_of;

class StreamTest : public test::StreamFiles {};

TEST_F(StreamTest, ShowsWhatTheWholeModelShows) {
  std::uint64_t seed = 0;
  for (const Kind kind : test::all_kinds) {
    const Mesh mesh = test::random_mesh(kind, 150, ++seed);
    const std::string stl = file("a.stl", stl_of(mesh)), ply = file("b.ply", ply_of(mesh));
    for (const std::uint32_t at_once : {7u, 1u << 19}) {
      expect_streams_as_whole({stl}, at_once);
      expect_streams_as_whole({ply}, at_once);
    }
  }
}

TEST_F(StreamTest, SmoothNormalsReachAcrossPieces) {
  Scene teapot = builtin("teapot");
  Mesh mesh = teapot.meshes[0];
  const std::string ply = file("pot.ply", ply_of(mesh)), stl = file("pot.stl", stl_of(mesh));
  for (const std::uint32_t at_once : {1000u, 97u}) {
    expect_streams_as_whole({ply}, at_once);
    expect_streams_as_whole({stl}, at_once);
  }
}

TEST_F(StreamTest, SeveralFilesAreObjectsInTheirOrder) {
  const std::string a = file("a.stl", stl_of(test::random_mesh(Kind::soup, 200, 1)));
  const std::string empty = file("empty.stl", stl_of({}));
  const std::string b = file("b.ply", ply_of(test::random_mesh(Kind::shared_grid, 300, 2)));
  const std::string c = file("c.stl", stl_of(test::random_mesh(Kind::coplanar, 100, 3)));
  for (const std::uint32_t at_once : {11u, 1000u}) expect_streams_as_whole({a, empty, b, c, a}, at_once);
}

TEST_F(StreamTest, BrokenFilesGiveTheErrorsOfTheReader) {
  const Mesh mesh = test::random_mesh(Kind::shared_grid, 60, 5);
  for (const std::string& text : {stl_of(mesh), ply_of(mesh)}) {
    const bool is_stl = text[0] == 'a';
    for (std::size_t cut = is_stl ? 60 : text.size() - 300; cut < text.size(); cut += 41) {
      const std::string path = file(is_stl ? "cut.stl" : "cut.ply", text.substr(0, cut));
      EXPECT_EQ(test::error_of(path, 5), test::error_of_whole(path)) << cut;
    }
    std::string wild = text;
    wild[wild.size() - 2] = '\x7f';  // a vertex index out of range; in STL, a coordinate
    const std::string path = file(is_stl ? "wild.stl" : "wild.ply", wild);
    EXPECT_EQ(test::error_of(path, 5), test::error_of_whole(path));
  }
}

TEST_F(StreamTest, OtherFormatsAreRefused) {
  EXPECT_THROW(Stream({file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}), Error);
  EXPECT_THROW(Stream({file("a.stl", "solid a\nendsolid a\n")}), Error);
  EXPECT_THROW(Stream({"builtin:teapot"}), Error);
  EXPECT_THROW(Stream({}), Error);
  EXPECT_THROW(Stream({folder_.file("missing.stl")}), Error);
}

// The files are empty, but promise 4,294,967,294 triangles together: as many as a scene may have.
TEST_F(StreamTest, MoreTrianglesThanAScenesAreRefusedAtOnce) {
  const auto promising = [&](const std::string& name, std::uint32_t triangles) {
    std::string header(80, '\0');
    put(header, triangles);
    const std::string path = file(name, header);
    std::error_code error;
    std::filesystem::resize_file(path, 84 + 50 * std::uint64_t(triangles), error);
    return error ? std::string() : path;
  };
  const std::string most = promising("most.stl", 1'500'000'000), rest = promising("rest.stl", 1'294'967'294),
                    one = promising("one.stl", 1);
  if (most.empty() || rest.empty()) GTEST_SKIP() << "no sparse files here";
  EXPECT_NO_THROW(Stream({most, rest, most}));
  try {
    Stream({most, rest, most, one});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
    EXPECT_THAT(error.what(), testing::HasSubstr("more than 4294967294 triangles"));
  }
}

TEST_F(StreamTest, SaysHowOftenItWasReadAndGoesOnWhereItIsMoved) {
  const Mesh mesh = test::bumpy_ball(20, 0.1f, 1);
  const std::string path = file("bumps.stl", stl_of(mesh));
  Stream first({path}, {.load = {}, .triangles_at_once = 100});
  EXPECT_TRUE(first.can_repeat());
  EXPECT_EQ(first.passes(), 0);
  EXPECT_TRUE(first.bounds().is_empty());
  ASSERT_EQ(first.scene().instances.size(), 1u);
  EXPECT_TRUE(first.scene().meshes.at(first.scene().instances[0].mesh).triangles.empty());
  const Scene whole = load(path);
  const Surfaces surfaces(whole);
  const View view = frame(surfaces, 40, 30);
  const std::uint64_t hash = content_hash(zbuffer(surfaces, view));
  Excerpt excerpt = first.look({view});
  EXPECT_EQ(first.passes(), 1);
  Stream second = std::move(first);
  Excerpt moved = std::move(excerpt);
  EXPECT_EQ(content_hash(moved.in_stream(moved.visible[0])), hash);
  excerpt = second.look({view});
  EXPECT_EQ(second.passes(), 2);
  EXPECT_EQ(second.triangle_count(), mesh.triangles.size());
  EXPECT_EQ(content_hash(excerpt.in_stream(excerpt.visible[0])), hash);
  moved = std::move(excerpt);
  EXPECT_EQ(content_hash(moved.in_stream(moved.visible[0])), hash);
}

TEST_F(StreamTest, PiecesHaveASize) {
  const std::string path = file("bumps.stl", stl_of(test::bumpy_ball(4, 0.1f, 1)));
  for (const std::uint32_t size : {0u, (1u << 24) + 1}) try {
      const Stream stream({path}, {.load = {}, .triangles_at_once = size});
      ADD_FAILURE() << size;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_STREQ(error.what(), "triangles_at_once: must be 1 to 16777216");
    }
}

}  // namespace
}  // namespace frontmost
