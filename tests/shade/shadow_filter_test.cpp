// SPDX-License-Identifier: Apache-2.0
#include "shade/shadow/shadow_filter.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

namespace frontmost::shading {
namespace {

/// Row by row, as the mean is defined.
float row_by_row(const ShadowWindow& w) {
  float sum = 0;
  for (int j = 0; j < shadow_taps; ++j) {
    float lit = 0;
    for (int i = 0; i < shadow_taps; ++i)
      lit += w.keys[std::size_t(i) * w.stride + std::size_t(j)] <= w.key ? w.across[i] : 0.0f;
    sum += lit * w.down[j];
  }
  return sum;
}

TEST(ShadowFilter, IsTheSameToTheBitForEveryInstructionSet) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> draw(0, 4);
  constexpr std::size_t size = 40;
  std::vector<float> map(size * size);
  int partly = 0;
  for (int round = 0; round < 2000; ++round) {
    for (float& key : map) key = draw(random);
    ShadowWindow window{map.data() + random() % (size - shadow_taps), size, draw(random), {}, {}};
    for (int k = 0; k < shadow_taps; ++k) window.across[k] = draw(random), window.down[k] = draw(random);
    if (round % 7 == 0) window.key = map[0];  // equal is lit
    const float expected = row_by_row(window);
    partly += expected > 0;
    for (const Isa isa : available_isas()) {
      const float sum = shadow_filter(isa)(window);
      ASSERT_EQ(std::memcmp(&sum, &expected, sizeof sum), 0) << name(isa) << ": " << sum << ", not " << expected;
    }
  }
  EXPECT_GT(partly, 1500);
}

}  // namespace
}  // namespace frontmost::shading
