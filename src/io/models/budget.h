// SPDX-License-Identifier: Apache-2.0
// What a small file may make of memory and time.
#pragma once

#include <cstdint>
#include <string>

#include "io/models/model_source.h"

namespace frontmost {

/// Elements can be repeated, shared and left out, so that a few bytes stand for
/// many. Honest files stay far below the limit.
class Budget {
 public:
  explicit Budget(std::uint64_t file_bytes) : left_(base + factor * file_bytes) {}
  /// \throws Error limit_exceeded.
  void charge(std::uint64_t count, std::uint64_t size, const std::string& place, const ModelSource& source);

 private:
  // The most that an honest byte becomes is 16: an index of one byte makes a triangle of a strip. Four times that
  // leaves room for posed copies of a mesh; the base lets tiny files repeat what they hold.
  static constexpr std::uint64_t base = std::uint64_t(1) << 28, factor = 64;
  std::uint64_t left_;
};

}  // namespace frontmost
