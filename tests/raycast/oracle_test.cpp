// SPDX-License-Identifier: Apache-2.0
// The ray caster against the oracle, to the bit: every instruction set, several threads, every kind of scene.

#include <gtest/gtest.h>

#include <cstring>

#include "ray_oracle.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

void expect_same(const Visible& expected, const Visible& actual) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = 0; i < expected.keys.size(); ++i)
    if (expected.primitives[i] != actual.primitives[i] || std::memcmp(&expected.keys[i], &actual.keys[i], 4) != 0)
      if (count++ == 0) first = i;
  EXPECT_EQ(count, 0u) << "first at sample " << first << " (x " << first % std::size_t(expected.view.width) << ", y "
                       << first / std::size_t(expected.view.width) << "): primitive " << expected.primitives[first]
                       << " key " << expected.keys[first] << " expected, " << actual.primitives[first] << " key "
                       << actual.keys[first] << " found";
}

std::size_t covered(const Visible& visible) {
  std::size_t count = 0;
  for (const PrimitiveId id : visible.primitives) count += id != no_primitive;
  return count;
}

class EveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(RayCast, EveryKind, testing::ValuesIn(all_kinds));

TEST_P(EveryKind, EqualsTheOracleOnEveryInstructionSet) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 0; seed < seeds(24); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed + 100);
    const bool covers_little = GetParam() == Kind::tiny || GetParam() == Kind::slivers;
    const Scene scene = scene_of(random_mesh(GetParam(), (30 + random.below(300)) * (covers_little ? 6 : 1), seed));
    const Surfaces surfaces(scene);
    View view = random_view(random, 1 + random.below(200), 1 + random.below(170));
    view.culling = Culling(random.below(3));
    view.samples = seed % 4 == 3 ? 4 : 1;
    const Visible expected = ray_oracle(surfaces, view);
    seen += covered(expected);
    const RayIndex index(surfaces);
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(name(isa));
      expect_same(expected, raycast(index, view, {.threads = 1, .isa = isa}));
    }
  }
  EXPECT_GT(seen, 1'000u) << "the scenes have become empty";
}

TEST(RayCast, EqualsTheOracleWithEverySampleCount) {
  for (const int samples : {1, 2, 4, 8, 16}) {
    SCOPED_TRACE(testing::Message() << samples << " samples");
    Random random(7);
    const Scene scene = scene_of(random_mesh(Kind::soup, 300, 5));
    const Surfaces surfaces(scene);
    View view = random_view(random, 150, 140);
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
