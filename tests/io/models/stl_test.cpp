// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "frontmost/io.h"
#include "support/models.h"

namespace frontmost {
namespace {

TEST(Stl, BinaryBunny) {
  FRONTMOST_NEEDS_MODELS();
  const Scene scene = load(test::model("organic/stanford-bunny-binary.stl"));
  EXPECT_EQ(triangle_count(scene), 69451u);
  EXPECT_EQ(scene.name, "stanford-bunny-binary");
  EXPECT_EQ(scene.up, Axis::z);
  EXPECT_EQ(scene.meshes.at(0).positions.size(), 208353u);
}

}  // namespace
}  // namespace frontmost
