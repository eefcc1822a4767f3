// SPDX-License-Identifier: Apache-2.0
// The kernels against their plain functions, bit for bit.
#include <gtest/gtest.h>

#include "lines/hiding/occluder.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using namespace lines_detail;

/// A point of a coarse lattice, so that many points are collinear, coplanar or equal.
glm::vec3 place(Random& random) {
  const auto coordinate = [&] { return std::round(random.within(-3, 3)) * 0.5f; };
  const float x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}

/// A mesh whose vertex n lies at place n.
struct Lattice {
  std::vector<glm::vec3> places;

  explicit Lattice(Random& random) {
    for (int i = 0; i < 40; ++i) places.push_back(place(random));
  }
  [[nodiscard]] std::uint32_t pick(Random& random) const {
    return std::min(std::uint32_t(random.within(0, float(places.size()))), std::uint32_t(places.size() - 1));
  }
};

Occluder random_occluder(const Lattice& lattice, const Sight& sight, Random& random) {
  Occluder o{};
  while (o.turn == 0) {
    std::uint32_t v[3] = {lattice.pick(random), lattice.pick(random), lattice.pick(random)};
    std::sort(v, v + 3);
    for (int k = 0; k < 3; ++k) {
      o.vertices[k] = v[k];
      o.corners[k] = lattice.places[v[k]];
    }
    o.turn = sight.facing(glm::dvec3(o.corners[0]), glm::dvec3(o.corners[1]), glm::dvec3(o.corners[2]));
  }
  return o;
}

SightedEdge random_edge(const Lattice& lattice, Random& random) {
  const std::uint32_t a = lattice.pick(random), b = lattice.pick(random);
  return {glm::dvec3(lattice.places[a]), glm::dvec3(lattice.places[b]), {a, a}, {b, b}};
}

/// Compares a kernel with `plain_function`, which is hidden_by() or covered_by().
void expect_equal(Interval (*plain_function)(const Occluder&, const SightedEdge&, const Sight&), bool covers) {
  std::size_t hidden = 0, open = 0;
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(name(isa));
    const ShadowKernels kernels = shadow_kernels(isa);
    for (std::uint64_t seed = 0; seed < seeds(4000); ++seed) {
      Random random(seed);
      View view = random_view(random, 64, 64);
      const Sight sight(view);
      const Lattice lattice(random);
      const SightedEdge edge = random_edge(lattice, random);
      OccluderBatch batch;
      std::vector<Occluder> occluders;
      for (std::uint64_t i = 0; i < 1 + seed % OccluderBatch::most; ++i)
        occluders.push_back(random_occluder(lattice, sight, random));
      for (const Occluder& occluder : occluders) batch.add(occluder);
      HiddenBatch found;
      (covers ? kernels.cover : kernels.hide)(batch, edge, sight, found);
      ASSERT_EQ((found.hides | found.open) >> batch.count, 0u);
      for (std::size_t i = 0; i < batch.count; ++i) {
        if (found.open >> i & 1) {
          ++open;
          continue;
        }
        const Interval plain = plain_function(occluders[i], edge, sight);
        ASSERT_EQ(found.hides >> i & 1, plain.begin < plain.end) << seed;
        if (!(plain.begin < plain.end)) continue;
        ++hidden;
        ASSERT_EQ(found.begin[i], plain.begin) << seed;
        ASSERT_EQ(found.end[i], plain.end) << seed;
      }
    }
  }
  EXPECT_GT(hidden, 500u);
  EXPECT_LT(open, 20 * hidden);
}

TEST(ShadowKernels, HideAsThePlainFunctionOnEveryInstructionSet) { expect_equal(hidden_by, false); }
TEST(ShadowKernels, CoverAsThePlainFunctionOnEveryInstructionSet) { expect_equal(covered_by, true); }

TEST(ShadowKernels, FindTheBoxesThatOverlap) {
  constexpr std::size_t most = 64;
  for (std::uint64_t seed = 0; seed < seeds(400); ++seed) {
    Random random(seed);
    float values[5][most];
    for (std::size_t i = 0; i < most; ++i) {
      for (int axis = 0; axis < 2; ++axis) {
        values[axis][i] = random.within(0, 10);
        values[2 + axis][i] = values[axis][i] + random.within(0, 4);
      }
      values[4][i] = random.within(1, 2);
    }
    const ScreenBoxes boxes{values[0], values[1], values[2], values[3], values[4]};
    const ScreenPart part{{3, 4}, {5, 5}, 1.5f};
    const std::size_t count = 1 + seed % most;
    std::uint64_t expected = 0;
    for (std::size_t i = 0; i < count; ++i)
      if (values[0][i] <= 5 && values[2][i] >= 3 && values[1][i] <= 5 && values[3][i] >= 4 && values[4][i] <= 1.5f)
        expected |= std::uint64_t(1) << i;
    for (const Isa isa : available_isas())
      ASSERT_EQ(shadow_kernels(isa).overlapping(boxes, count, part), expected) << name(isa);
  }
}

}  // namespace
}  // namespace frontmost::test
