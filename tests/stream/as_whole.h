// SPDX-License-Identifier: Apache-2.0
// Files to stream, and checks of a stream against the model that is loaded as a whole.
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "frontmost/pictures.h"
#include "frontmost/streams.h"
#include "frontmost/zbuffer.h"
#include "support/scratch_folder.h"

namespace frontmost::test {

template <class T>
void put(std::string& text, const T& value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  text.append(bytes, sizeof(T));
}

inline std::string stl_of(const Mesh& mesh) {
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

inline std::string ply_of(const Mesh& mesh) {
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

class StreamFiles : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& contents) const {
    write_text(folder_.file(name), contents);
    return folder_.file(name);
  }
  ScratchFolder folder_;
};

inline void expect_same(const Visible& a, const Visible& b) {
  ASSERT_EQ(a.keys.size(), b.keys.size());
  ASSERT_EQ(content_hash(a), content_hash(b));
}

inline Scene loaded(const std::vector<std::string>& paths) {
  Scene whole = load(paths.front());
  for (std::size_t i = 1; i < paths.size(); ++i) add(whole, load(paths[i]));
  return whole;
}

/// Compares framing, visibility, the lit picture and normals of a stream with those of the loaded files. If ranks
/// stream together, all of them call this, and the first compares the results.
inline void expect_as_whole(Stream& stream, const std::vector<std::string>& paths, bool has_results = true) {
  const Scene scene = loaded(paths);
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 96, 72);
  const Scene outline = stream.outline(view);
  const View framed = frame(Surfaces(outline), 96, 72);
  EXPECT_EQ(framed.world_from_eye, view.world_from_eye);
  EXPECT_EQ(framed.projection.clip.near, view.projection.clip.near);
  EXPECT_EQ(framed.projection.clip.far, view.projection.clip.far);
  EXPECT_EQ(stream.bounds().low, surfaces.bounds().low);
  EXPECT_EQ(stream.bounds().high, surfaces.bounds().high);

  View picture = view;
  picture.samples = 4;
  const Excerpt excerpt = stream.look({picture, view}, {.key_light = true, .smooth_normals = true}, {.threads = 2});
  EXPECT_EQ(stream.triangle_count(), surfaces.primitive_count());
  EXPECT_EQ(excerpt.visible.size(), has_results ? 2u : 0u);
  if (!has_results) return;
  const Visible whole = zbuffer(surfaces, picture), whole_map = zbuffer(surfaces, view);
  expect_same(excerpt.in_stream(excerpt.visible[0]), whole);
  expect_same(excerpt.in_stream(excerpt.visible[1]), whole_map);

  const ShadeInput input{.visible = &excerpt.visible[0],
                         .seen_by_light = excerpt.seen_by_light ? &*excerpt.seen_by_light : nullptr};
  EXPECT_EQ(content_hash(shade(excerpt.surfaces(), input)), content_hash(shade(surfaces, whole)));
  EXPECT_EQ(content_hash(normal_image(excerpt.surfaces(), excerpt.visible[1])),
            content_hash(normal_image(surfaces, whole_map)));
  EXPECT_EQ(content_hash(id_image(excerpt.surfaces(), excerpt.visible[1], IdKind::object)),
            content_hash(id_image(surfaces, whole_map, IdKind::object)));
}

/// Compares files streamed here, in pieces of `at_once` triangles, with the loaded files.
inline void expect_streams_as_whole(const std::vector<std::string>& paths, std::uint32_t at_once) {
  SCOPED_TRACE(testing::Message() << paths.front() << ", " << at_once << " at once");
  Stream stream(paths, {.load = {}, .triangles_at_once = at_once});
  expect_as_whole(stream, paths);
}

/// Message of the error that reading all of a stream ends in; "read" if there is none.
inline std::string error_of(const std::string& path, std::uint32_t at_once) {
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

inline std::string error_of_whole(const std::string& path) {
  try {
    (void)load(path);
    return "read";
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace frontmost::test
