// SPDX-License-Identifier: Apache-2.0
// One triangle thousands of times: rays meet the first of them, whatever the order of the leaves is.

#include <gtest/gtest.h>

#include "indexed_scene.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

TEST(Repeats, RaysMeetTheFirst) {
  Mesh mesh;
  const int count = under_sanitizer ? 500 : 20'000;
  for (int i = 0; i < count; ++i) {
    add_triangle(mesh, {-9, -9, 0}, {9, -9, 0.1f}, {0, 9, 0});
    add_triangle(mesh, {-9, -9, -1}, {9, -9, 1}, {0, 9, 0.1f});
  }
  // Behind both of them, so that the pair is in front of something and not of nothing alone.
  add_triangle(mesh, {-90, -90, -2}, {90, -90, -2}, {0, 90, -2});
  const Indexed in(scene_of(std::move(mesh)));
  View view;
  view.width = 300, view.height = 200;
  view.world_from_eye = look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(0.9, 1.5, {0.1, 10});
  const Visible seen = raycast(in.index, view);
  bool both = false;
  for (const PrimitiveId id : seen.primitives) {
    ASSERT_LT(id, 2u);
    both = both || id != seen.primitives[0];
  }
  EXPECT_TRUE(both);
}

}  // namespace
}  // namespace frontmost::test
