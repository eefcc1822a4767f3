// SPDX-License-Identifier: Apache-2.0
// Limits of the memory and time that a small file may cause.
//
//   honest:    1 byte of the file ---> at most 16 bytes of the scene
//   hostile:   a vertex that one-byte indices name again and again, a mesh of two triangles that is placed a million
//              times, an image of one colour
//
// Each reader that can multiply elements charges a budget first. The budget is several times what an honest file of
// that size needs.
#pragma once

#include <cstdint>
#include <string>

#include "io/models/model_source.h"

namespace frontmost {

/// Files can repeat, share and omit elements, so a few bytes may stand for many elements. Honest files stay far below
/// the limit.
class Budget {
 public:
  explicit Budget(std::uint64_t file_bytes) : left_(base + factor * file_bytes) {}
  /// \throws Error limit_exceeded.
  void charge(std::uint64_t count, std::uint64_t size, const std::string& place, const ModelSource& source) {
    if (count > left_ / size)
      source.fail_limit(place, std::to_string(count) + " elements are far more than a file of this size should make");
    left_ -= count * size;
  }

 private:
  // An honest byte becomes at most 16 bytes, because a one-byte index makes a triangle of a strip. Four times that
  // leaves room for posed copies of a mesh; the base lets tiny files repeat their contents.
  static constexpr std::uint64_t base = std::uint64_t(1) << 28, factor = 64;
  std::uint64_t left_;
};

/// Budget of pixels. A file of 32 kB can hold an image of a gigabyte in one colour, but real images have some 1 to 30
/// pixels a byte. Each byte of an image file allows 64 pixels; 8192 x 8192 more are free.
class PixelBudget {
 public:
  void add_file(std::uint64_t byte_count) { left_ += pixels_per_byte * byte_count; }
  /// \returns false, without taking any pixels, if they exceed the budget.
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
