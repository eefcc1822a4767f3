// SPDX-License-Identifier: Apache-2.0
// Models written into memory by hand, and functions that load them.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "frontmost/files.h"

namespace frontmost::test {

inline std::span<const std::byte> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

/// Loads `text` as a model called "model".
inline Scene load_text(const std::string& text, std::optional<ModelFormat> format = std::nullopt) {
  return load(bytes_of(text), "model", {.format = format, .up = {}});
}

/// Message of the error that loading ends in; "read" if there is none. Each error names its file and its reason.
inline std::string error_of(const std::string& text, std::optional<ModelFormat> format) {
  try {
    (void)load_text(text, format);
    return "read";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), "model") << error.what();
    EXPECT_FALSE(error.reason().empty()) << error.what();
    return error.what();
  }
}

/// Appends the bytes of numbers in the order of this (little-endian) machine, or in the other one.
class ByteWriter {
 public:
  explicit ByteWriter(bool big = false) : big_(big) {}

  template <class T>
  ByteWriter& put(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big_) std::reverse(bytes, bytes + sizeof(T));
    text.append(bytes, sizeof(T));
    return *this;
  }
  template <class T>
  ByteWriter& put(std::initializer_list<T> values) {
    for (const T value : values) put(value);
    return *this;
  }

  std::string text;

 private:
  bool big_;
};

}  // namespace frontmost::test
