// SPDX-License-Identifier: Apache-2.0
// Images to write and read, and bitwise comparisons.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "frontmost/files.h"
#include "support/seeds.h"

namespace frontmost::test {

inline Channel float_channel(const std::string& name, std::vector<float> values) {
  Buffer<float> buffer(values.size());
  std::copy(values.begin(), values.end(), buffer.begin());
  return {name, std::move(buffer)};
}

inline Channel id_channel(const std::string& name, std::vector<std::uint32_t> values) {
  Buffer<std::uint32_t> buffer(values.size());
  std::copy(values.begin(), values.end(), buffer.begin());
  return {name, std::move(buffer)};
}

/// Channels of random bits, or of random numbers in [low, high].
inline Image random_floats(int width, int height, const std::vector<std::string>& names, float low = 0,
                           float high = 1) {
  std::mt19937 random(test::noted_seed(unsigned(width * 31 + height)));
  std::uniform_real_distribution<float> number(low, high);
  Image image{width, height, {}};
  for (const std::string& name : names) {
    Buffer<float> values(std::size_t(width) * std::size_t(height));
    for (float& value : values) value = number(random);
    image.channels.push_back({name, std::move(values)});
  }
  return image;
}

inline Image random_ids(int width, int height, const std::vector<std::string>& names, std::uint32_t most = no_index) {
  std::mt19937 random(test::noted_seed(unsigned(width * 37 + height)));
  Image image{width, height, {}};
  for (const std::string& name : names) {
    Buffer<std::uint32_t> values(std::size_t(width) * std::size_t(height));
    for (std::uint32_t& value : values) value = std::uint32_t(random() % (std::uint64_t(most) + 1));
    image.channels.push_back({name, std::move(values)});
  }
  return image;
}

/// Puts infinities, NaN and other odd floats into the first channel, as far as there is room.
inline void add_odd_values(Image& image) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const float odd[] = {infinity, -infinity, std::numeric_limits<float>::quiet_NaN(), -0.0f, 1e-45f, 3e38f};
  Buffer<float>& values = image.channels[0].floats();
  for (std::size_t i = 0; i < std::size(odd) && i < values.size(); ++i) values[i] = odd[i];
}

inline void expect_same_bits(const Image& actual, const Image& expected) {
  ASSERT_EQ(actual.width, expected.width);
  ASSERT_EQ(actual.height, expected.height);
  ASSERT_EQ(actual.channels.size(), expected.channels.size());
  for (const Channel& channel : expected.channels) {
    SCOPED_TRACE("channel " + channel.name);
    const Channel* other = actual.find(channel.name);
    ASSERT_NE(other, nullptr);
    ASSERT_EQ(other->is_integer(), channel.is_integer());
    if (channel.is_integer()) {
      ASSERT_EQ(other->integers().size(), channel.integers().size());
      EXPECT_EQ(0, std::memcmp(other->integers().data(), channel.integers().data(), channel.integers().size() * 4));
    } else {
      ASSERT_EQ(other->floats().size(), channel.floats().size());
      EXPECT_EQ(0, std::memcmp(other->floats().data(), channel.floats().data(), channel.floats().size() * 4));
    }
  }
}

inline ErrorCode error_of(const std::function<void()>& action, std::string* message = nullptr) {
  try {
    action();
  } catch (const Error& error) {
    if (message) *message = error.what();
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::bad_argument;
}

/// Code and message of the error that reading ends in; "read" if there is none. The bytes lie in memory of exactly
/// their size, so that AddressSanitizer detects every byte read beyond it.
inline std::string image_error(const std::string& bytes) {
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  const std::vector<std::byte> exact(first, first + bytes.size());
  try {
    (void)load_image(exact, "m");
    return "read";
  } catch (const Error& error) {
    const char* code = error.code() == ErrorCode::file_malformed   ? "malformed, "
                       : error.code() == ErrorCode::limit_exceeded ? "limit, "
                       : error.code() == ErrorCode::unsupported    ? "unsupported, "
                                                                   : "another code, ";
    return code + std::string(error.what());
  }
}

}  // namespace frontmost::test
