// SPDX-License-Identifier: Apache-2.0
// Every collected model through the whole path: read, flattened, seen, shaded. The bytes are the same by every
// instruction set and any number of threads, and by the oracle for small models.

#include <iostream>

#include "frontmost/frontmost.h"
#include "support/models.h"
#include "support/oracle.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

/// The oracle's time is the number of triangles times pixels.
bool is_small(const Surfaces& surfaces) { return surfaces.primitive_count() <= 6000; }

void expect_oracles_answer(const Surfaces& surfaces) {
  const View view = frame(surfaces, 96, 72);
  const Visible expected = oracle(surfaces, view), actual = zbuffer(surfaces, view);
  expect_same(expected, actual);
}

TEST(AllModels, AreSeenAlikeByEveryInstructionSetAndNumberOfThreads) {
  FRONTMOST_NEEDS_MODELS();
  const std::vector<std::string> names = good_models();
  std::size_t by_oracle = 0, without_triangles = 0;
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const Scene scene = load(model(name));
    const Surfaces surfaces(scene);
    const View view = frame(surfaces, 400, 300);
    const Visible visible = zbuffer(surfaces, view, {.threads = 1});
    // Points and lines are models without triangles.
    if (surfaces.primitive_count() == 0) {
      EXPECT_EQ(covered(visible), 0u);
      ++without_triangles;
      continue;
    }
    // One model has holes wherever alpha is below 1.1.
    const bool is_all_hole = name.ends_with("Material_AlphaMask_03.gltf");
    EXPECT_EQ(covered(visible) > 1000, !is_all_hole) << "seen of " << surfaces.primitive_count() << " triangles";
    for (const Isa isa : available_isas())
      EXPECT_EQ(content_hash(visible), content_hash(zbuffer(surfaces, view, {.threads = 3, .isa = isa})));
    if (is_small(surfaces)) {
      expect_oracles_answer(surfaces);
      ++by_oracle;
    }
  }
  EXPECT_GE(names.size(), under_sanitizer ? 50u : 60u);
  EXPECT_GE(by_oracle, 20u);
  EXPECT_LT(without_triangles, 10u);
  std::cout << names.size() << " models, " << by_oracle << " of them against the oracle, " << without_triangles
            << " without triangles\n";
}

TEST(AllModels, AreShadedAlikeByAnyNumberOfThreads) {
  FRONTMOST_NEEDS_MODELS();
  for (const std::string& name : good_models()) {
    SCOPED_TRACE(name);
    const Scene scene = load(model(name));
    const Surfaces surfaces(scene);
    View view = frame(surfaces, 160, 120);
    view.samples = 4;
    const Visible visible = zbuffer(surfaces, view);
    const Image one = shade(surfaces, visible, {}, {.threads = 1});
    EXPECT_EQ(content_hash(one), content_hash(shade(surfaces, visible, {}, {.threads = 4})));
    for (const char* channel : {"R", "G", "B", "A"})
      for (const float value : one.find(channel)->floats()) ASSERT_TRUE(value >= 0 && value < 100) << channel << value;
  }
}

}  // namespace
}  // namespace frontmost::test
