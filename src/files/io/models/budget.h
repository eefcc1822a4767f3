// SPDX-License-Identifier: Apache-2.0
// What a small file may make of memory and time.
//
//   honest:    1 byte of the file ---> at most 16 bytes of the scene
//   hostile:   a vertex that is named again and again by indices of a byte, a mesh of two triangles that is placed a
//              million times, an image of one colour
//
// So every reader that can multiply asks a budget first, which is as large as an honest file of that size could need
// several times over.
#pragma once

#include <cstdint>
#include <string>

#include "io/models/model_source.h"

namespace frontmost {

/// Elements can be repeated, shared and left out, so that a few bytes stand for many. Honest files stay far below the
/// limit.
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
  // The most that an honest byte becomes is 16: an index of one byte makes a triangle of a strip. Four times that
  // leaves room for posed copies of a mesh; the base lets tiny files repeat what they hold.
  static constexpr std::uint64_t base = std::uint64_t(1) << 28, factor = 64;
  std::uint64_t left_;
};

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
