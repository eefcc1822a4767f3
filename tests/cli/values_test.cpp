// SPDX-License-Identifier: Apache-2.0
// Values as users write them: accepted ones, and the messages for refused ones.
#include "cli/values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.h"

namespace frontmost::cli {
namespace {

using test::complaint;
using testing::HasSubstr;

TEST(Values, NumbersAreTakenWhole) {
  EXPECT_EQ(parse_number("1.5"), 1.5);
  EXPECT_EQ(parse_number("+2e3"), 2000);
  EXPECT_EQ(parse_number(" -0.25 "), -0.25);
  for (const char* text : {"", "1.5x", "1,5", "x", "--1", "+-1", "0x10", "1 2", "١"}) {
    EXPECT_THAT(complaint([&] { return parse_number(text); }), HasSubstr("is not a number")) << text;
  }
}

TEST(Values, NumbersThatCannotBeUsedAreRefused) {
  for (const char* text : {"nan", "inf", "-inf", "1e99", "NaN", "infinity"}) {
    EXPECT_THAT(complaint([&] { return parse_number(text); }), HasSubstr("usable")) << text;
  }
  EXPECT_THAT(complaint([] { return parse_number("7", {0, 5}); }), HasSubstr("7 is not between 0 and 5"));
  EXPECT_THAT(complaint([] { return parse_integer("1.5", {0, 5}); }), HasSubstr("whole"));
  EXPECT_THAT(complaint([] { return parse_number("1e999", {0, 5}); }), HasSubstr("1e999 is not between 0 and 5"));
}

TEST(Values, VectorsHaveTheirCount) {
  EXPECT_EQ(parse_vector("1,-2,3.5"), glm::dvec3(1, -2, 3.5));
  EXPECT_THAT(complaint([] { return parse_vector("1,2"); }), HasSubstr("2 values, 3 are needed"));
  EXPECT_THAT(complaint([] { return parse_vector("1,2,3,"); }), HasSubstr("4 values"));
  EXPECT_THAT(complaint([] { return parse_vector("1,,3"); }), HasSubstr("'' is not a number"));
}

TEST(Values, DirectionsMayBeAxes) {
  EXPECT_EQ(parse_direction("-z"), glm::dvec3(0, 0, -1));
  EXPECT_EQ(parse_direction("+X"), glm::dvec3(1, 0, 0));
  EXPECT_EQ(parse_direction("y"), glm::dvec3(0, 1, 0));
  EXPECT_EQ(parse_direction("0,0,2"), glm::dvec3(0, 0, 2));
  EXPECT_THAT(complaint([] { return parse_direction("0,0,0"); }), HasSubstr("no direction"));
  EXPECT_THAT(complaint([] { return parse_direction("w"); }), HasSubstr("1 values"));
}

TEST(Values, ChoicesNameTheOthers) {
  EXPECT_EQ(parse_choice("back", "none|back|front|both"), 1);
  EXPECT_THAT(complaint([] { return parse_choice("bck", "none|back"); }), HasSubstr("not one of none, back"));
  EXPECT_THAT(complaint([] { return parse_choice("", "none|back"); }), HasSubstr("not one of"));
}

TEST(Values, ColorsInEverySpelling) {
  EXPECT_EQ(parse_color("#ff0000"), glm::vec3(1, 0, 0));
  EXPECT_EQ(parse_color("#0f0"), glm::vec3(0, 1, 0));
  EXPECT_EQ(parse_color("0,0.5,1"), glm::vec3(0, 0.5, 1));
  EXPECT_EQ(parse_color("white"), glm::vec3(1));
  for (const char* text : {"#ff00", "#gggggg", "mauve", "#"}) {
    EXPECT_THAT(complaint([&] { return parse_color(text); }), HasSubstr("is not a colour")) << text;
  }
  EXPECT_THAT(complaint([] { return parse_color("0,0,2"); }), HasSubstr("not between 0 and 1"));
}

TEST(Values, MatricesAreRowsHoweverSeparated) {
  const auto matrix = parse_matrix("[[1,0,0,7],[0,1,0,8],[0,0,1,9],[0,0,0,1]]");
  ASSERT_TRUE(matrix);
  EXPECT_EQ((*matrix)[3], glm::dvec4(7, 8, 9, 1));
  EXPECT_EQ(parse_matrix("1 0 0 7\n0 1 0 8\n0 0 1 9\n"), matrix);
  EXPECT_FALSE(parse_matrix("pose.txt"));
  EXPECT_THAT(complaint([] { return parse_matrix("1 2 3"); }), HasSubstr("3 numbers"));
  EXPECT_THAT(complaint([] { return parse_matrix("nan 2 3"); }), HasSubstr("finite"));
}

TEST(Values, NearestWordForgivesTypingOnly) {
  constexpr std::string_view words[] = {"camera-position", "camera-direction", "depth"};
  EXPECT_EQ(nearest_word("camera-postion", words), "camera-position");
  EXPECT_EQ(nearest_word("detph", words), "depth");
  EXPECT_EQ(nearest_word("colour", words), "");
}

}  // namespace
}  // namespace frontmost::cli
