// SPDX-License-Identifier: Apache-2.0
// Colours grouped by cells give the same result as colours one by one.
#include <gtest/gtest.h>

#include "figures/coloring/pieces.h"
#include "support/random_scene.h"

namespace frontmost::shading {
namespace {

TEST(ColorGroups, AreThoseOfAllPairs) {
  for (const float reach : {0.0f, 2.0f, 40.0f}) {
    test::Random random(7);
    ColorGroups groups(reach);
    std::vector<glm::vec4> colors;
    for (int i = 0; i < 1500; ++i) {
      glm::vec4 color(0);
      for (int k = 0; k < 4; ++k) color[k] = float(random.below(reach == 0 ? 6 : 25500)) / 100;
      std::uint32_t expected = 0;
      while (expected < colors.size() && difference(colors[expected], color) > reach) ++expected;
      if (expected == colors.size()) colors.push_back(color);
      ASSERT_EQ(groups.find_or_add(color), expected) << reach << ' ' << i;
    }
    EXPECT_EQ(groups.colors(), colors);
    EXPECT_GT(colors.size(), 100u);
  }
}

TEST(ColorGroups, APhotographTakesNoSquare) {
  test::Random random(8);
  ColorGroups groups(2);
  for (int i = 0; i < 100000; ++i) {
    glm::vec4 color(255);
    for (int k = 0; k < 3; ++k) color[k] = random.within(0, 255);
    (void)groups.find_or_add(color);
  }
  EXPECT_GT(groups.colors().size(), 70000u);  // one by one this would take half a minute
}

}  // namespace
}  // namespace frontmost::shading
