// SPDX-License-Identifier: Apache-2.0
// Holding a stream against the model that is read whole.
#pragma once

#include <gtest/gtest.h>

#include "frontmost/shade.h"
#include "frontmost/stream.h"
#include "frontmost/zbuffer.h"
#include "support/scratch_folder.h"

namespace frontmost::test {

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

/// Framing, visibility, the lit picture and normals of files streamed in pieces of `at_once`.
inline void expect_streams_as_whole(const std::vector<std::string>& paths, std::uint32_t at_once) {
  SCOPED_TRACE(testing::Message() << paths.front() << ", " << at_once << " at once");
  const Scene scene = loaded(paths);
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 96, 72);
  Stream stream(paths, {.load = {}, .triangles_at_once = at_once});
  const Scene outline = stream.outline(view);
  const View framed = frame(Surfaces(outline), 96, 72);
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

  const ShadeInput input(excerpt.visible[0], excerpt.seen_by_light ? &*excerpt.seen_by_light : nullptr);
  EXPECT_EQ(content_hash(shade(excerpt.surfaces(), input)), content_hash(shade(surfaces, whole)));
  EXPECT_EQ(content_hash(normal_image(excerpt.surfaces(), excerpt.visible[1])),
            content_hash(normal_image(surfaces, whole_map)));
  EXPECT_EQ(content_hash(id_image(excerpt.surfaces(), excerpt.visible[1], IdKind::object)),
            content_hash(id_image(surfaces, whole_map, IdKind::object)));
}

/// The words of the error that reading all of a stream ends in; "read" if there is none.
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
