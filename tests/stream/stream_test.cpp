// SPDX-License-Identifier: Apache-2.0
// A stream shows to the bit what the model shows that is read whole, however small its pieces are.
#include "frontmost/stream.h"

#include <gtest/gtest.h>

#include <cstring>

#include "frontmost/shade.h"
#include "frontmost/zbuffer.h"
#include "io/models/model_stream.h"
#include "support/random_scene.h"
#include "support/scratch_folder.h"

namespace frontmost {
namespace {

using test::Kind;

template <class T>
void put(std::string& text, const T& value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  text.append(bytes, sizeof(T));
}

std::string stl_of(const Mesh& mesh) {
  std::string text = "a part";
  text.resize(80, '\0');
  put(text, std::uint32_t(mesh.triangles.size()));
  for (const glm::uvec3& t : mesh.triangles) {
    put(text, glm::vec3(0));
    for (int k = 0; k < 3; ++k) put(text, mesh.positions[t[k]]);
    put(text, std::uint16_t(0));
  }
  return text;
}

std::string ply_of(const Mesh& mesh) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nelement face " +
      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const glm::vec3& p : mesh.positions) {
    put(text, p);
    for (int k = 0; k < 3; ++k) put(text, std::uint8_t(int(100 * std::abs(p[k])) % 256));
  }
  for (const glm::uvec3& t : mesh.triangles) {
    put(text, std::uint8_t(3));
    put(text, t);
  }
  return text;
}

class StreamTest : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& contents) const {
    test::write_text(folder_.file(name), contents);
    return folder_.file(name);
  }
  test::ScratchFolder folder_;
};

void expect_same(const Visible& a, const Visible& b) {
  ASSERT_EQ(a.keys.size(), b.keys.size());
  ASSERT_EQ(content_hash(a), content_hash(b));
}

Scene loaded(const std::vector<std::string>& paths) {
  Scene whole = load(paths.front());
  for (std::size_t i = 1; i < paths.size(); ++i) append(whole, load(paths[i]));
  return whole;
}

/// Framing, visibility, the lit picture and normals of files streamed in pieces of `at_once`.
void expect_streams_as_whole(const std::vector<std::string>& paths, std::uint32_t at_once) {
  SCOPED_TRACE(testing::Message() << paths.front() << ", " << at_once << " at once");
  const Scene scene = loaded(paths);
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 160, 120);
  Stream stream(paths, {.load = {}, .triangles_at_once = at_once});
  const Scene outline = stream.outline(view);
  const View framed = frame(Surfaces(outline), 160, 120);
  ASSERT_EQ(framed.world_from_eye, view.world_from_eye);
  ASSERT_EQ(framed.projection.clip.near, view.projection.clip.near);
  ASSERT_EQ(framed.projection.clip.far, view.projection.clip.far);
  ASSERT_EQ(stream.bounds().low, surfaces.bounds().low);
  ASSERT_EQ(stream.bounds().high, surfaces.bounds().high);

  View picture = view;
  picture.samples = 4;
  const Excerpt excerpt = stream.look({picture, view}, {.key_light = true, .smooth_normals = true}, {.threads = 2});
  ASSERT_EQ(stream.triangle_count(), surfaces.primitive_count());
  const Visible whole = zbuffer(surfaces, picture), whole_map = zbuffer(surfaces, view);
  expect_same(excerpt.in_stream(excerpt.visible[0]), whole);
  expect_same(excerpt.in_stream(excerpt.visible[1]), whole_map);

  ShadeOptions options;
  if (excerpt.seen_by_light) options.seen_by_light = &*excerpt.seen_by_light;
  EXPECT_EQ(content_hash(shade(excerpt.surfaces(), excerpt.visible[0], options)), content_hash(shade(surfaces, whole)));
  EXPECT_EQ(content_hash(normal_image(excerpt.surfaces(), excerpt.visible[1])),
            content_hash(normal_image(surfaces, whole_map)));
  EXPECT_EQ(content_hash(id_image(excerpt.surfaces(), excerpt.visible[1], IdKind::object)),
            content_hash(id_image(surfaces, whole_map, IdKind::object)));
}

TEST_F(StreamTest, ShowsWhatTheWholeModelShows) {
  std::uint64_t seed = 0;
  for (const Kind kind : test::all_kinds) {
    const Mesh mesh = test::random_mesh(kind, 400, ++seed);
    const std::string stl = file("a.stl", stl_of(mesh)), ply = file("b.ply", ply_of(mesh));
    for (const std::uint32_t at_once : {7u, 100u, 1u << 19}) {
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

/// The words of the error that reading all of a stream ends in; "read" if there is none.
std::string error_of(const std::string& path, std::uint32_t at_once) {
  try {
    View view;
    view.width = view.height = 8;
    view.projection = make_projection(1, 1, {0.1, 10});
    Stream stream({path}, {.load = {}, .triangles_at_once = at_once});
    (void)stream.look({view});
    return "read";
  } catch (const Error& error) {
    return error.what();
  }
}

std::string error_of_whole(const std::string& path) {
  try {
    (void)load(path);
    return "read";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST_F(StreamTest, BrokenFilesGiveTheErrorsOfTheReader) {
  const Mesh mesh = test::random_mesh(Kind::shared_grid, 60, 5);
  for (const std::string& text : {stl_of(mesh), ply_of(mesh)}) {
    const bool is_stl = text[0] == 'a';
    for (std::size_t cut = is_stl ? 60 : text.size() - 300; cut < text.size(); cut += 41) {
      const std::string path = file(is_stl ? "cut.stl" : "cut.ply", text.substr(0, cut));
      EXPECT_EQ(error_of(path, 5), error_of_whole(path)) << cut;
    }
    std::string wild = text;
    wild[wild.size() - 2] = '\x7f';  // a corner out of range; a number in STL
    const std::string path = file(is_stl ? "wild.stl" : "wild.ply", wild);
    EXPECT_EQ(error_of(path, 5), error_of_whole(path));
  }
}

TEST_F(StreamTest, OtherFormatsAreRefused) {
  EXPECT_THROW(Stream({file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}), Error);
  EXPECT_THROW(Stream({file("a.stl", "solid a\nendsolid a\n")}), Error);
  EXPECT_THROW(Stream({"builtin:teapot"}), Error);
  EXPECT_THROW(Stream({}), Error);
  EXPECT_THROW(Stream({folder_.file("missing.stl")}), Error);
}

// Three files, empty in truth, that promise 1.5e9 triangles each: more than ids can tell apart.
TEST_F(StreamTest, MoreTrianglesThanIdsAreRefusedAtOnce) {
  std::string header(80, '\0');
  put(header, std::uint32_t(1'500'000'000));
  const std::string path = file("huge.stl", header);
  std::error_code error;
  std::filesystem::resize_file(path, 84 + 50 * std::uint64_t(1'500'000'000), error);
  if (error) GTEST_SKIP() << "no sparse files here";
  EXPECT_NO_THROW(Stream({path, path}));
  EXPECT_THROW(Stream({path, path, path}), Error);
}

}  // namespace
}  // namespace frontmost
