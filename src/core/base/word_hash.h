// SPDX-License-Identifier: Apache-2.0
// A hash that tells data apart, and is not for security: collisions can be constructed.
#pragma once

#include <cstdint>

namespace frontmost {

/// FNV-1a over words of 64 bits instead of bytes: eight times as fast, and the data is no text.
class WordHash {
 public:
  void add(std::uint64_t word) { value_ = (value_ ^ word) * 0x100000001B3u; }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

}  // namespace frontmost
