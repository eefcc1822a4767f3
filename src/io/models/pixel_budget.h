// SPDX-License-Identifier: Apache-2.0
// How many pixels the textures of a model may have together.
#pragma once

#include <cstdint>

namespace frontmost {

/// A file of 32 kB can hold an image of a gigabyte, all of one colour. Real ones have some 1 to 30 pixels a byte: every
/// byte of an image file earns 64, and 8192 x 8192 are free.
class PixelBudget {
 public:
  void add_file(std::uint64_t byte_count) { left_ += pixels_per_byte * byte_count; }
  /// False: that is too much, and nothing is taken.
  [[nodiscard]] bool take(std::uint64_t pixels) {
    if (pixels > left_) return false;
    left_ -= pixels;
    return true;
  }

 private:
  static constexpr std::uint64_t pixels_per_byte = 64;
  std::uint64_t left_ = std::uint64_t(1) << 26;
};

}  // namespace frontmost
