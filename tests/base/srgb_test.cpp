// SPDX-License-Identifier: Apache-2.0
// The sRGB tables against the standard's formula in long double.
#include "base/srgb.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/odd_numbers.h"

namespace frontmost {
namespace {

long double formula(long double linear) {
  return linear <= 0.0031308L ? 12.92L * linear : 1.055L * std::pow(linear, 1 / 2.4L) - 0.055L;
}

int byte_by_formula(float linear) {
  if (!(linear > 0)) return 0;
  return int(std::floor(255 * formula(std::fmin(linear, 1.0f)) + 0.5L));
}

TEST(Srgb, BytesEqualTheFormulaOnBothSidesOfEveryThreshold) {
  for (int byte = 1; byte < 256; ++byte) {
    const long double value = (byte - 0.5L) / 255;
    const long double exact = value <= 0.04045L ? value / 12.92L : std::pow((value + 0.055L) / 1.055L, 2.4L);
    float x = float(exact);
    for (int i = 0; i < 4; ++i) x = std::nextafter(x, 0.0f);
    for (int i = 0; i < 9; ++i, x = std::nextafter(x, 2.0f)) {
      ASSERT_EQ(srgb8_of_linear(x), byte_by_formula(x)) << "at " << x;
      ASSERT_EQ(srgb8_of_linear(x), (long double)(x) >= exact ? byte : byte - 1) << "at " << x;
    }
  }
}

TEST(Srgb, BytesEqualTheFormulaAllOverTheRange) {
  // A stride that is prime to the bucket size visits all kinds of low bits.
  for (std::uint32_t bits = 0x38000000u; bits < 0x3F900000u; bits += 1009) {
    float x;
    std::memcpy(&x, &bits, sizeof x);
    ASSERT_EQ(srgb8_of_linear(x), byte_by_formula(x)) << "at " << x;
  }
}

TEST(Srgb, OddValuesAreClamped) {
  for (const float low : {0.0f, -0.0f, -1.0f, -test::kFloatInfinity, std::nanf(""), -std::nanf(""), 1e-40f}) {
    EXPECT_EQ(srgb8_of_linear(low), 0);
    EXPECT_EQ(srgb16_of_linear(low), 0);
  }
  for (const float high : {1.0f, 2.0f, 1e30f, test::kFloatInfinity}) {
    EXPECT_EQ(srgb8_of_linear(high), 255);
    EXPECT_EQ(srgb16_of_linear(high), 65535);
  }
}

TEST(Srgb, FloatsAreRoundedToSixteenBits) {
  for (int byte = 0; byte < 256; ++byte) {
    EXPECT_EQ(linear_of_srgb(float(byte) / 255), linear_of_srgb16(std::uint16_t(257 * byte)));
    EXPECT_EQ(linear_of_srgb(float(byte) / 255), linear_of_srgb8(std::uint8_t(byte)));
  }
  EXPECT_EQ(linear_of_srgb(0.25f), linear_of_srgb16(16384));  // 65535 / 4 is 16383.75
  EXPECT_EQ(linear_of_srgb(0.75f), linear_of_srgb16(49151));  // 49151.25
  for (const float low : {-0.0f, -1.0f, -test::kFloatInfinity}) EXPECT_EQ(linear_of_srgb(low), 0);
  for (const float high : {1.0f, 2.0f, test::kFloatInfinity, std::nanf("")}) EXPECT_EQ(linear_of_srgb(high), 1);
}

TEST(Srgb, KnownValues) {
  EXPECT_EQ(srgb8_of_linear(0.5f), 188);
  EXPECT_EQ(srgb8_of_linear(0.2140f), 127);
  EXPECT_NEAR(linear_of_srgb8(128), 0.2158605, 1e-7);
  EXPECT_EQ(linear_of_srgb8(0), 0.0f);
  EXPECT_EQ(linear_of_srgb8(255), 1.0f);
}

TEST(Srgb, EveryValueSurvivesTheRoundTrip) {
  for (int byte = 0; byte < 256; ++byte) ASSERT_EQ(srgb8_of_linear(linear_of_srgb8(std::uint8_t(byte))), byte);
  for (int word = 0; word < 65536; ++word) ASSERT_EQ(srgb16_of_linear(linear_of_srgb16(std::uint16_t(word))), word);
}

TEST(Srgb, SixteenBitsEqualTheFormula) {
  for (std::uint32_t bits = 0x36000000u; bits <= 0x3F800000u; bits += 7919) {
    float x;
    std::memcpy(&x, &bits, sizeof x);
    ASSERT_EQ(srgb16_of_linear(x), int(std::floor(65535 * formula(x) + 0.5L))) << "at " << x;
    ASSERT_NEAR(srgb_of_linear(x), double(formula(x)), 1e-14) << "at " << x;
  }
}

/// srgb_of_linear() rounded, without any shortcut.
int word_by_function(float linear) { return int(srgb_of_linear(double(linear)) * 65535 + 0.5); }

TEST(Srgb, SixteenBitsAreTheRoundedFunctionAllOverTheRange) {
  // The stride is prime to the pieces' 65536 floats, so ends, middles and the doubtful values next to steps all occur.
  for (std::uint32_t bits = 0x36000000u; bits <= 0x3F800000u; bits += 61) {
    float x;
    std::memcpy(&x, &bits, sizeof x);
    ASSERT_EQ(srgb16_of_linear(x), word_by_function(x)) << "at " << x;
  }
}

TEST(Srgb, SixteenBitsAreRightOnBothSidesOfEveryStep) {
  for (int word = 1; word < 65536; ++word) {
    const double value = (word - 0.5) / 65535;
    float x = float(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
    for (int i = 0; i < 3; ++i) x = std::nextafter(x, 0.0f);
    for (int i = 0; i < 7; ++i, x = std::nextafter(x, 2.0f)) ASSERT_EQ(srgb16_of_linear(x), word_by_function(x));
  }
}

}  // namespace
}  // namespace frontmost
