// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "io/models/text.h"
#include "support/seeds.h"

namespace frontmost {
namespace {

/// Parses from a buffer of exactly the text's size. \returns the number of characters taken, or -1.
std::ptrdiff_t parse(const std::string& text, float& value) {
  const std::unique_ptr<char[]> exact(new char[text.size()]);
  std::copy(text.begin(), text.end(), exact.get());
  const char* after = parse_float(exact.get(), exact.get() + text.size(), value);
  return after == nullptr ? -1 : after - exact.get();
}

TEST(ParseFloat, TakesWhatFilesHold) {
  const struct {
    const char* text;
    std::ptrdiff_t taken;
    float value;
  } cases[] = {{"0", 1, 0.0f},
               {"-0.0", 4, -0.0f},
               {"1.5 2", 3, 1.5f},
               {"+2", 2, 2.0f},
               {".5", 2, 0.5f},
               {"5.", 2, 5.0f},
               {"-1e3x", 4, -1000.0f},
               {"1e", 1, 1.0f},
               {"1e+", 1, 1.0f},
               {"1e+2", 4, 100.0f},
               {"007", 3, 7.0f},
               {"0.1", 3, 0.1f},
               {"3.4028235e38", 12, 3.4028235e38f},
               {"1e-45", 5, 1e-45f},
               {"1/2", 1, 1.0f},
               {"16777217", 8, 16777216.0f},
               {"16777219", 8, 16777220.0f}};
  for (const auto& c : cases) {
    float value = -99;
    EXPECT_EQ(parse(c.text, value), c.taken) << c.text;
    EXPECT_EQ(value, c.value) << c.text;
    EXPECT_EQ(std::signbit(value), std::signbit(c.value)) << c.text;
  }
}

TEST(ParseFloat, RefusesWhatIsNone) {
  for (const char* text : {"", "-", "+", ".", "-.", "e5", ".e5", "x", "--1", "na", "info", "nano", "#1"}) {
    float value = 0;
    EXPECT_EQ(parse(text, value), -1) << text;
  }
}

TEST(ParseFloat, KnowsNanAndInfinityInEverySpelling) {
  for (const char* text : {"nan", "NaN", "-nan", "1.#QNAN", "-1.#IND", "1.#IND00", "1.#SNAN", "nan(ind)", "-nan(ind)",
                           "nan(snan)", "NaN(0x7ff)"}) {
    float value = 0;
    EXPECT_EQ(parse(text, value), std::ptrdiff_t(std::string(text).size())) << text;
    EXPECT_TRUE(std::isnan(value)) << text;
  }
  for (const char* text : {"inf", "-Inf", "INFINITY", "1.#INF", "-1.#INF00", "1e39", "-1e999", "1e99999999999999999999",
                           "100000000000000000000000000000000000000000"}) {
    float value = 0;
    EXPECT_EQ(parse(text, value), std::ptrdiff_t(std::string(text).size())) << text;
    EXPECT_TRUE(std::isinf(value)) << text;
    EXPECT_EQ(std::signbit(value), text[0] == '-') << text;
  }
  for (const char* text : {"1e-999", "0e999", "0.000000000000000000000000000000000000000000000000001", "-1e-60"}) {
    float value = 1;
    EXPECT_GT(parse(text, value), 0) << text;
    EXPECT_EQ(value, 0.0f) << text;
  }
}

// The C library's strtof is slow but rounds correctly.
TEST(ParseFloat, RoundsLikeTheCLibrary) {
  std::mt19937_64 random(test::noted_seed(1));
  std::size_t compared = 0;
  for (int i = 0; i < 300'000; ++i) {
    std::string text = random() % 2 ? "-" : "";
    const int digits = 1 + int(random() % 20), point = int(random() % 21);
    for (int k = 0; k < digits; ++k) {
      if (k == point) text += '.';
      text += char('0' + random() % 10);
    }
    if (random() % 4 == 0) text.append(1, 'e').append(std::to_string(int(random() % 100) - 50));
    float value = 0;
    ASSERT_EQ(parse(text, value), std::ptrdiff_t(text.size())) << text;
    ASSERT_EQ(value, std::strtof(text.c_str(), nullptr)) << text;
    ++compared;
  }
  EXPECT_EQ(compared, 300'000u);
}

// Numbers half way between two floats, and one digit to either side: rounding twice would show here.
TEST(ParseFloat, RoundsHalfWaysOnce) {
  std::mt19937 random(test::noted_seed(2));
  for (int i = 0; i < 20'000; ++i) {
    const auto low = float(random() % (1 << 24)) / 1024;
    const double half = (double(low) + double(std::nextafter(low, 1e9f))) / 2;
    char text[64];
    std::snprintf(text, sizeof text, "%.24f", half);
    std::string digits = text;
    digits.erase(digits.find_last_not_of('0') + 1);
    for (const std::string& number : {digits, digits + "1", digits.substr(0, digits.size() - 1) + "4"}) {
      float value = 0;
      ASSERT_GT(parse(number, value), 0);
      ASSERT_EQ(value, std::strtof(number.c_str(), nullptr)) << number;
    }
  }
}

TEST(ParseInteger, TakesUpTo18Digits) {
  const auto parse_all = [](const std::string& text, std::int64_t& value) {
    const char* after = parse_integer(text.data(), text.data() + text.size(), value);
    return after == nullptr ? -1 : after - text.data();
  };
  std::int64_t value = 0;
  EXPECT_EQ(parse_all("42/7", value), 2);
  EXPECT_EQ(value, 42);
  EXPECT_EQ(parse_all("-3", value), 2);
  EXPECT_EQ(value, -3);
  EXPECT_EQ(parse_all("999999999999999999", value), 18);
  EXPECT_EQ(value, 999999999999999999);
  for (const char* text : {"", "-", "x", "1000000000000000000", "99999999999999999999999999"})
    EXPECT_EQ(parse_all(text, value), -1) << text;
}

TEST(ParseBoth, GivesTheNearestFloatAndTheNearestDouble) {
  std::mt19937_64 random(test::noted_seed(7));
  std::vector<std::string> texts = {"0",
                                    "-0.0",
                                    "nan",
                                    "-inf",
                                    "1e39",
                                    "1e-50",
                                    "5400000.25",
                                    "100000000.01",
                                    "16777217.000000000000000000001",
                                    "9007199254740993",
                                    "1e400",
                                    "x",
                                    "-"};
  for (int i = 0; i < 20000; ++i) {
    char text[64];
    const double value = std::ldexp(double(random() >> 11), int(random() % 120) - 100);
    std::snprintf(text, sizeof text, random() % 2 ? "%.*g" : "%.*f", int(random() % 20), value);
    texts.emplace_back(text);
  }
  for (const std::string& text : texts) {
    float rounded = 0, alone = 0;
    double exact = 0;
    const char* const end = text.data() + text.size();
    const char* const after = parse_both(text.data(), end, rounded, exact);
    ASSERT_EQ(after, parse_float(text.data(), end, alone)) << text;
    if (after == nullptr) continue;
    const double expected = std::strtod(text.c_str(), nullptr);
    ASSERT_EQ(std::memcmp(&rounded, &alone, sizeof alone), 0) << text;
    ASSERT_TRUE(exact == expected || (std::isnan(exact) && std::isnan(expected))) << text;
    ASSERT_EQ(std::signbit(exact), std::signbit(expected)) << text;
  }
}

}  // namespace
}  // namespace frontmost
