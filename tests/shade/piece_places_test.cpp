// SPDX-License-Identifier: Apache-2.0
// Hems of a figure's pieces.
#include "shade/figure/coloring/piece_places.h"

#include <gtest/gtest.h>

namespace frontmost::shading {
namespace {

PaintCorner corner(double x, double y) { return {{x, y, 1}, false}; }

/// Of the lower half of an outline, beside the line between its halves.
std::optional<std::array<PaintCorner, 2>> hem_above(const std::vector<PaintCorner>& outline, double left,
                                                    double right) {
  std::vector<ScreenLine> room;
  append_sides(outline, room);
  const auto hem = hem_within(corner(left, 20), corner(right, 20), room, 4);
  for (std::size_t k = 0; hem && k < 2; ++k)
    for (const ScreenLine& side : room) EXPECT_GT(side.distance(glm::dvec2((*hem)[k].at)), 0);
  return hem;
}

TEST(HemWithin, IsAsWideAsThereIsRoom) {
  const auto hem = hem_above({corner(0, 0), corner(0, 40), corner(80, 40), corner(80, 0)}, 0, 80);
  ASSERT_TRUE(hem);
  EXPECT_EQ((*hem)[0].at.y, 24);
  EXPECT_EQ((*hem)[1].at.y, 24);
}

/// Nothing as wide everywhere has room in a wedge that is as long as 20 times its width.
TEST(HemWithin, TapersTowardsWedges) {
  const auto to_right = hem_above({corner(0, 0), corner(0, 24), corner(80, 20)}, 0, 80);
  ASSERT_TRUE(to_right);
  EXPECT_GE((*to_right)[0].at.y, 21);
  const auto to_left = hem_above({corner(0, 20), corner(80, 24), corner(80, 0)}, 0, 80);
  ASSERT_TRUE(to_left);
  EXPECT_GE((*to_left)[1].at.y, 21);
}

TEST(HemWithin, IsNotThereWithoutRoom) {
  EXPECT_FALSE(hem_above({corner(0, 0), corner(0, 20), corner(80, 20)}, 0, 80));
}

}  // namespace
}  // namespace frontmost::shading
