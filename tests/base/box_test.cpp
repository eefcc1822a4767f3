// SPDX-License-Identifier: Apache-2.0
// Boxes, errors and buffers: types that every room uses.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <new>
#include <numeric>

#include "base/memory.h"
#include "frontmost/base.h"
#include "support/odd_numbers.h"

namespace frontmost {
namespace {

TEST(Box, IsEmptyUntilSomethingIsInIt) {
  Box box;
  EXPECT_TRUE(box.is_empty());
  EXPECT_EQ(box.diagonal(), 0.0f);
  box.include(Box());
  EXPECT_TRUE(box.is_empty()) << "nothing and nothing";
  box.include(glm::vec3(1, 2, 3));
  EXPECT_FALSE(box.is_empty()) << "a point is a box";
  EXPECT_EQ(box.centre(), glm::vec3(1, 2, 3));
  EXPECT_EQ(box.diagonal(), 0.0f);
  const Box before = box;
  box.include(Box());
  EXPECT_EQ(box.low, before.low);
  EXPECT_EQ(box.high, before.high);
}

TEST(Box, GrowsToHoldWhatIsIncluded) {
  Box box;
  box.include(glm::vec3(3, 0, 0));
  box.include(glm::vec3(0, 4, 0));
  EXPECT_EQ(box.low, glm::vec3(0));
  EXPECT_EQ(box.high, glm::vec3(3, 4, 0));
  EXPECT_EQ(box.diagonal(), 5.0f);
  EXPECT_EQ(box.centre(), glm::vec3(1.5f, 2, 0));
  Box other;
  other.include(glm::vec3(-1, 1, 7));
  box.include(other);
  EXPECT_EQ(box.low, glm::vec3(-1, 0, 0));
  EXPECT_EQ(box.high, glm::vec3(3, 4, 7));
}

// A box that is reversed along one axis alone is empty; so is a box of NaN.
TEST(Box, OneAxisIsEnoughToBeEmpty) {
  for (int axis = 0; axis < 3; ++axis) {
    Box box{glm::vec3(0), glm::vec3(1)};
    box.high[axis] = -1e-30f;
    EXPECT_TRUE(box.is_empty()) << axis;
    box.high[axis] = std::nanf("");
    EXPECT_TRUE(box.is_empty()) << axis;
    box.high[axis] = 0;
    EXPECT_FALSE(box.is_empty()) << axis;
  }
}

// The middle is computed from the difference, which does not overflow where the sum of the ends would.
TEST(Box, TheCentreOfTheGreatestBoxes) {
  const float most = std::numeric_limits<float>::max();
  const Box far{glm::vec3(most / 2), glm::vec3(most)};
  EXPECT_EQ(far.centre(), glm::vec3(most / 2 + most / 4));
  EXPECT_EQ((Box{glm::vec3(-most / 2), glm::vec3(most / 2)}).centre(), glm::vec3(0));
  EXPECT_TRUE(std::isinf((Box{glm::vec3(0), glm::vec3(test::kFloatInfinity)}).diagonal()));
}

TEST(Error, KeepsItsCodeAndWords) {
  const Error error(ErrorCode::limit_exceeded, "a.stl: triangle 3: too far");
  EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
  EXPECT_STREQ(error.what(), "a.stl: triangle 3: too far");
  const std::runtime_error& base = error;
  EXPECT_STREQ(base.what(), "a.stl: triangle 3: too far") << "whoever knows no Error gets the words all the same";
}

TEST(Error, HasFilePlaceAndReason) {
  const Error whole(ErrorCode::file_malformed, "a.stl", "triangle 3", "too far");
  EXPECT_STREQ(whole.what(), "a.stl: triangle 3: too far");
  EXPECT_EQ(whole.file(), "a.stl");
  EXPECT_EQ(whole.place(), "triangle 3");
  EXPECT_EQ(whole.reason(), "too far");
  const Error of_value(ErrorCode::bad_argument, "near", "must be greater than 0");
  EXPECT_STREQ(of_value.what(), "near: must be greater than 0");
  EXPECT_EQ(of_value.file(), "");
  EXPECT_STREQ(Error(ErrorCode::file_unwritable, "a.png", "", "is a folder").what(), "a.png: is a folder");
  EXPECT_STREQ(Error(ErrorCode::cancelled, "cancelled").what(), "cancelled");
}

TEST(Error, WithinAFileKeepsWhatItNamed) {
  const Error of_value(ErrorCode::bad_argument, "near", "must be greater than 0");
  const Error of_file = of_value.within("views.json", "view front");
  EXPECT_EQ(of_file.code(), ErrorCode::bad_argument);
  EXPECT_STREQ(of_file.what(), "views.json: view front: near: must be greater than 0");
  EXPECT_EQ(of_file.place(), "view front: near");
  const Error of_two = of_file.within("all.json");
  EXPECT_EQ(of_two.file(), "all.json");
  EXPECT_STREQ(of_two.what(), "all.json: views.json: view front: near: must be greater than 0");
}

TEST(Buffer, CopiesAreDeepAndMovesLeaveNothing) {
  Buffer<int> first(5, 7);
  Buffer<int> copy = first;
  copy[2] = 1;
  EXPECT_EQ(first[2], 7);
  EXPECT_EQ(std::accumulate(copy.begin(), copy.end(), 0), 29);
  const int* const place = first.data();
  Buffer<int> moved = std::move(first);
  EXPECT_EQ(moved.data(), place);
  EXPECT_TRUE(first.empty());
  EXPECT_EQ(first.begin(), first.end());
  copy = moved;
  EXPECT_EQ(copy[2], 7);
  EXPECT_NE(copy.data(), moved.data());
  Buffer<int>& itself = copy;
  copy = itself;
  EXPECT_EQ(copy[4], 7) << "assigned to itself";
  copy = Buffer<int>();
  EXPECT_EQ(copy.size(), 0u);
}

TEST(Buffer, NothingAndTooMuch) {
  const Buffer<double> none(0);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.end() - none.begin(), 0);
  const Buffer<double> copy = none;
  EXPECT_EQ(copy.size(), 0u);
  // A request larger than the address space is refused, not wrapped around to a small size.
  EXPECT_THROW((void)detail::allocate(~std::size_t(0)), std::bad_alloc);
  EXPECT_THROW((void)detail::allocate(~std::size_t(0) - 64), std::bad_alloc);
}

TEST(Buffer, SwapsWhateverTheSizes) {
  Buffer<std::uint8_t> small(1, 9), none;
  small.swap(none);
  EXPECT_TRUE(small.empty());
  ASSERT_EQ(none.size(), 1u);
  EXPECT_EQ(none[0], 9);
}

TEST(Prefetch, AnyAddressWillDo) {
  prefetch_line(nullptr);
  prefetch_line(reinterpret_cast<const void*>(~std::uintptr_t(0)));
  const int number = 5;
  prefetch_line(&number);
  EXPECT_EQ(number, 5);
}

}  // namespace
}  // namespace frontmost
