// SPDX-License-Identifier: Apache-2.0
// Packing, masks and counting of lanes: every instruction set, and every set of lanes.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "base/lanes_kernel.h"

namespace frontmost::test {
namespace {

std::array<float, most_lanes> odd_values() {
  std::array<float, most_lanes> values{};
  for (std::size_t i = 0; i < most_lanes; ++i) values[i] = 0.5f + float(i);
  // Packing moves bits and must not interpret them.
  values[1] = -0.0f;
  values[2] = std::numeric_limits<float>::infinity();
  values[3] = std::numeric_limits<float>::denorm_min();
  return values;
}

/// Indices of the lanes in `set`: the definition of packing.
std::vector<std::size_t> members(std::uint32_t set, std::size_t lanes) {
  std::vector<std::size_t> list;
  for (std::size_t lane = 0; lane < lanes; ++lane)
    if (set >> lane & 1) list.push_back(lane);
  return list;
}

TEST(Compactor, EverySetOfLanesOnEveryInstructionSet) {
  const std::array<float, most_lanes> values = odd_values();
  for (const Isa isa : available_isas()) {
    SCOPED_TRACE(name(isa));
    const std::size_t lanes = pack(0, values, 0, isa).lanes;
    ASSERT_GE(lanes, 1u);
    ASSERT_LE(lanes, most_lanes);
    for (std::uint32_t set = 0; set < (1u << lanes); ++set) {
      const PackedVector packed = pack(set, values, -7, isa);
      const std::vector<std::size_t> expected = members(set, lanes);
      ASSERT_EQ(packed.count, expected.size()) << set;
      ASSERT_EQ(packed.count_into, expected.size()) << set;
      ASSERT_EQ(packed.bits, set);
      ASSERT_EQ(packed.visited, expected) << set;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_EQ(0, std::memcmp(&packed.floats[i], &values[expected[i]], sizeof(float))) << set << ", " << i;
        ASSERT_EQ(0, std::memcmp(&packed.into[i], &values[expected[i]], sizeof(float))) << set << ", " << i;
        ASSERT_EQ(packed.numbers[i], 100 + expected[i]) << set << ": one selection serves vectors of other types";
      }
      // Packing may write one whole vector, and no lane more, as lists have room for that.
      for (std::size_t i = lanes; i < packed.floats.size(); ++i) {
        ASSERT_EQ(packed.floats[i], -7.0f) << set;
        ASSERT_EQ(packed.into[i], -7.0f) << set;
      }
    }
  }
}

TEST(Compactor, BitsBeyondTheLanesCountForNothing) {
  for (const Isa isa : available_isas()) {
    const PackedVector packed = pack(0xFFFF, odd_values(), 0, isa);
    EXPECT_EQ(packed.count, packed.lanes) << name(isa);
    EXPECT_EQ(packed.bits, (std::uint64_t(1) << packed.lanes) - 1) << name(isa);
  }
}

TEST(CountFrom, GoesUpByOneAndWrapsAround) {
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  for (const Isa isa : available_isas())
    for (const std::int32_t first : {0, 1, -5, 1 << 24, most - 3}) {
      const std::vector<std::int32_t> numbers = count_from(first, isa);
      for (std::size_t i = 0; i < numbers.size(); ++i)
        ASSERT_EQ(std::uint32_t(numbers[i]), std::uint32_t(first) + std::uint32_t(i)) << name(isa);
    }
}

// Wider instruction sets come later in the list, and none exceeds the size of vector arrays.
TEST(Lanes, GrowFromSetToSet) {
  std::size_t before = 0;
  for (const Isa isa : available_isas()) {
    const std::size_t lanes = count_from(0, isa).size();
    EXPECT_GE(lanes, before) << name(isa);
    EXPECT_EQ(lanes & (lanes - 1), 0u) << name(isa) << ": a power of two";
    before = lanes;
  }
}

}  // namespace
}  // namespace frontmost::test
