// SPDX-License-Identifier: Apache-2.0
// Numbers for planar distances, so that counting can sort by distance: a farther distance has an equal or greater
// number.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

namespace frontmost::occlusion_detail {

inline constexpr float infinite_distance = std::numeric_limits<float>::infinity();

class DistanceRanges {
 public:
  static constexpr int most = 4096;

  DistanceRanges() = default;
  /// Ranges of the distances from `least` to `greatest`. In perspective distances must be positive, and farther ranges
  /// are longer; in parallel projection all ranges have one length. Distances beyond have the first or the last number.
  DistanceRanges(bool orthographic, float least, float greatest) : orthographic_(orthographic), least_(least) {
    if (!(least < greatest)) return;
    if (orthographic) {
      per_unit_ = float(most - 1) / (greatest - least);
      count_ = most;
      return;
    }
    const std::uint32_t bits = bits_of(greatest) - bits_of(least);
    while (bits >> shift_ >= std::uint32_t(most)) ++shift_;
    count_ = int(bits >> shift_) + 1;
  }

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int operator()(float distance) const {
    if (!(distance > least_)) return 0;
    // min() takes the limit first, and so returns it if the distance overflows and its share is NaN.
    if (orthographic_) return int(std::min(float(count_ - 1), (distance - least_) * per_unit_));
    // Positive floats are in the order of their bits, which grow like a logarithm.
    const std::uint32_t bits = bits_of(distance) - bits_of(least_);
    return std::min(int(bits >> shift_), count_ - 1);
  }
  /// A lower bound of all distances with this number or a greater one, for numbers from 0 to count().
  [[nodiscard]] float least_of(int number) const {
    // One step nearer than the rounding of operator() may put the border.
    if (orthographic_) return per_unit_ > 0 ? least_ + (float(number) - 0.01f) / per_unit_ : least_;
    return from_bits(bits_of(least_) + (std::uint32_t(number) << shift_));
  }

 private:
  [[nodiscard]] static std::uint32_t bits_of(float distance) {
    std::uint32_t bits;
    std::memcpy(&bits, &distance, sizeof bits);
    return bits;
  }
  [[nodiscard]] static float from_bits(std::uint32_t bits) {
    float distance;
    std::memcpy(&distance, &bits, sizeof distance);
    return distance;
  }

  bool orthographic_ = false;
  float least_ = 0, per_unit_ = 0;
  int shift_ = 0, count_ = 1;
};

}  // namespace frontmost::occlusion_detail
