// SPDX-License-Identifier: Apache-2.0
#include "surfaces/hilbert.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

namespace frontmost::test {
namespace {

/// Coordinate of a cell along an axis, from its Morton code.
int coordinate(std::uint32_t morton, int axis) {
  int result = 0;
  for (int level = 0; level < 10; ++level) result |= int(morton >> (3 * level + axis) & 1) << level;
  return result;
}

TEST(Hilbert, VisitsEveryCellOnceAndStepsThroughFaces) {
  for (int levels = 1; levels <= 6; ++levels) {
    SCOPED_TRACE(levels);
    const std::uint32_t count = 1u << (3 * levels);
    std::vector<std::uint32_t> cell_at(count, count);
    for (std::uint32_t morton = 0; morton < count; ++morton) {
      const std::uint32_t place = hilbert_place(morton, levels);
      ASSERT_LT(place, count);
      ASSERT_EQ(cell_at[place], count) << "two cells at one place";
      cell_at[place] = morton;
    }
    EXPECT_EQ(cell_at[0], 0u);
    for (std::uint32_t i = 1; i < count; ++i) {
      int distance = 0;
      for (int axis = 0; axis < 3; ++axis)
        distance += std::abs(coordinate(cell_at[i], axis) - coordinate(cell_at[i - 1], axis));
      ASSERT_EQ(distance, 1) << "place " << i;
    }
  }
}

TEST(Hilbert, HoldsTenLevels) {
  std::uint32_t most = 0;
  for (std::uint32_t morton = 0; morton < 1u << 30; morton += 1'000'003)
    most = std::max(most, hilbert_place(morton, 10));
  EXPECT_LT(most, 1u << 30);
  EXPECT_GT(most, 1u << 29);
}

}  // namespace
}  // namespace frontmost::test
