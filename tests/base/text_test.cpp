// SPDX-License-Identifier: Apache-2.0
// Names of any bytes become UTF-8 that shows the original bytes.
#include <gtest/gtest.h>

#include "frontmost/base.h"

namespace frontmost {
namespace {

TEST(Text, WhatIsUtf8StaysAsItIs) {
  for (const char* text : {"", "part.stl", "größe", "\u20AC", "\U0001F680", "a\\xE9", "\uFFFD"}) {
    EXPECT_EQ(utf8_text(text), text);
    EXPECT_EQ(printable_text(text), text);
  }
}

TEST(Text, BytesThatAreNoCharacterAreWrittenOut) {
  EXPECT_EQ(utf8_text("caf\xE9.stl"), R"(caf\xE9.stl)");
  EXPECT_EQ(utf8_text("\xFF\xC3("), R"(\xFF\xC3()");
  EXPECT_EQ(utf8_text("\xE2\x82"), R"(\xE2\x82)") << "cut off";
  EXPECT_EQ(utf8_text("\xC0\x80"), R"(\xC0\x80)") << "longer than needed";
  EXPECT_EQ(utf8_text("\xE0\x9F\xBF"), R"(\xE0\x9F\xBF)");
  EXPECT_EQ(utf8_text("\xF0\x8F\xBF\xBF"), R"(\xF0\x8F\xBF\xBF)");
  EXPECT_EQ(utf8_text("\xED\xA0\x80"), R"(\xED\xA0\x80)") << "half of a pair";
  EXPECT_EQ(utf8_text("\xF4\x90\x80\x80"), R"(\xF4\x90\x80\x80)") << "beyond the last";
  EXPECT_EQ(utf8_text("\x80z"), R"(\x80z)");
}

TEST(Text, ControlCharactersAreWrittenOutWhereTheyWouldBeObeyed) {
  EXPECT_EQ(utf8_text("a\n\x1B[31m"), "a\n\x1B[31m");
  EXPECT_EQ(printable_text("a\n\x1B[31m\x7F"), R"(a\x0A\x1B[31m\x7F)");
  EXPECT_EQ(printable_text(std::string_view("a\0b", 3)), R"(a\x00b)");
  EXPECT_EQ(printable_text("\u009B31m\u00A0"), "\\xC2\\x9B31m\u00A0");
  EXPECT_EQ(printable_text("\uFFFE\uFFFF"), R"(\xEF\xBF\xBE\xEF\xBF\xBF)");
}

}  // namespace
}  // namespace frontmost
