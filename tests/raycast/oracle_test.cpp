// SPDX-License-Identifier: Apache-2.0
// The ray caster against the oracle, to the bit: every instruction set, several threads, every kind of scene.

#include <gtest/gtest.h>

#include "ray_oracle.h"
#include "support/cutout_scene.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

class EveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(RayCast, EveryKind, testing::ValuesIn(all_kinds));

TEST_P(EveryKind, EqualsTheOracleOnEveryInstructionSet) {
  expect_oracle_on_every_isa(
      GetParam(), [](const Surfaces& surfaces, const View& view) { return ray_oracle(surfaces, view); },
      [](const Surfaces& surfaces, const View& view, const Execution& how) { return raycast(surfaces, view, how); });
}

TEST_P(EveryKind, EqualsTheOracleThroughHoles) {
  for (std::uint64_t seed = 0; seed < seeds(10); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed + 300);
    const Scene scene = cutout_scene(random_mesh(GetParam(), 100 + random.below(100), seed), Cut(seed % 2), 0.5f, seed);
    const Surfaces surfaces(scene);
    View view = random_view(random, 1 + random.below(100), 1 + random.below(90));
    view.culling = Culling(random.below(3));
    view.samples = seed % 4 == 3 ? 4 : 1;
    expect_same(ray_oracle(surfaces, view), raycast(surfaces, view));
  }
}

TEST(RayCast, EqualsTheOracleWithEverySampleCount) {
  for (const int samples : {1, 2, 4, 8, 16}) {
    SCOPED_TRACE(testing::Message() << samples << " samples");
    Random random(7);
    const Scene scene = scene_of(random_mesh(Kind::soup, 300, 5));
    const Surfaces surfaces(scene);
    View view = tries_little ? random_view(random, 50, 40) : random_view(random, 150, 140);
    view.samples = samples;
    const Visible expected = ray_oracle(surfaces, view);
    for (const Isa isa : available_isas()) expect_same(expected, raycast(surfaces, view, {.isa = isa}));
  }
}

TEST(RayCast, ThreadsDoNotChangeAnything) {
  Random random(11);
  const Scene scene = scene_of(random_mesh(Kind::tiny, 60'000, 3));
  const Surfaces surfaces(scene);
  const View view = random_view(random, 333, 222);
  const Visible alone = raycast(surfaces, view, {.threads = 1});
  for (const int threads : {2, 3, 7}) expect_same(alone, raycast(surfaces, view, {.threads = threads}));
}

}  // namespace
}  // namespace frontmost::test
