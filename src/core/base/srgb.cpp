// SPDX-License-Identifier: Apache-2.0
// The sRGB function by roots instead of powers, and its tables, which are computed at compile time.
//
// srgb8_of_linear() looks up a float by the upper half of its bits. A bucket holds at most one threshold from one byte
// to the next. Adding the lower half of the bits to its entry carries into the byte exactly from the threshold on:
//
//   entry            | byte     | 65536 - threshold |
//   + lower half     | 0        | bits              |
//   = upper half     byte, or byte + 1 if the bits reach the threshold
#include "base/srgb.h"

#include <cmath>

namespace frontmost {
namespace {

// The exponent 2.4 is 12/5, so both directions are roots of products. Newton's iteration for a root uses only
// operations that every machine, and the compiler, rounds alike.

/// value^(12/5) for value in (0.05, 1].
constexpr double power_12_5(double value) {
  const double square = value * value;
  const double fourth = square * square;
  const double twelfth = fourth * fourth * fourth;
  double root = square;  // above the fifth root, to which the iteration falls
  for (int i = 0; i < 16; ++i) {
    const double root2 = root * root;
    root = (4 * root + twelfth / (root2 * root2)) / 5;
  }
  return root;
}

/// value^(5/12) for value in (0.003, 1].
double power_5_12(double value) {
  const double square = value * value;
  const double cube = std::sqrt(std::sqrt(square * square * value));  // sqrt is rounded correctly everywhere
  double root = 0.22 + cube * (1.38 - 0.6 * cube);                    // within a factor of 3
  for (int i = 0; i < 7; ++i) root = (2 * root + cube / (root * root)) / 3;
  return root;
}

constexpr double exact_linear_of(double value) {
  return value <= 0.04045 ? value / 12.92 : power_12_5((value + 0.055) / 1.055);
}

/// The bits of the smallest float that is not below `value`, for value in (0, 1).
constexpr std::uint32_t float_bits_from(double value) {
  std::uint32_t exponent = 127;
  while (value < 1) {
    value *= 2;
    --exponent;
  }
  const double mantissa = (value - 1) * 8388608.0;
  const auto whole = std::uint32_t(mantissa);
  return (exponent << 23) + whole + (double(whole) < mantissa ? 1 : 0);  // a carry correctly moves on into the exponent
}

/// By byte, from 1 on: the least float that becomes this byte.
constexpr std::array<std::uint32_t, 255> thresholds() {
  std::array<std::uint32_t, 255> result{};
  for (int byte = 1; byte < 256; ++byte)
    result[std::size_t(byte - 1)] = float_bits_from(exact_linear_of((byte - 0.5) / 255));
  return result;
}

constexpr std::array<std::uint32_t, detail::srgb8_bucket_count> buckets() {
  std::array<std::uint32_t, detail::srgb8_bucket_count> result{};
  const auto threshold = thresholds();
  std::uint32_t byte = 0;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::uint32_t first = detail::least_srgb8_bits + std::uint32_t(i << 16);
    if (byte < 255 && threshold[byte] <= first) ++byte;
    const bool changes = byte < 255 && threshold[byte] <= (first | 0xFFFFu);
    result[i] = (byte << 16) + (changes ? 0x10000u - (threshold[byte] & 0xFFFFu) : 0);
    if (changes) ++byte;
  }
  return result;
}

constexpr bool buckets_hold_one_threshold_each() {
  const auto threshold = thresholds();
  for (std::size_t i = 1; i < threshold.size(); ++i)
    if (threshold[i] >> 16 == threshold[i - 1] >> 16) return false;
  return threshold[0] > detail::least_srgb8_bits;
}
static_assert(buckets_hold_one_threshold_each());

constexpr std::array<float, 256> linear_table() {
  std::array<float, 256> result{};
  for (int byte = 0; byte < 256; ++byte) result[std::size_t(byte)] = float(exact_linear_of(byte / 255.0));
  return result;
}

constexpr double kLinearEnd = 0.0031308;  ///< end of the linear segment near zero

double curved(double linear) { return 1.055 * power_5_12(linear) - 0.055; }

/// 65535 times the curved segment. Each parabola stands for 65536 neighbouring floats, and goes through both ends and
/// the middle.
class Parabolas {
 public:
  Parabolas() {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const double begin = start(i), end = start(i + 1);
      const double low = 65535 * curved(begin), middle = 65535 * curved(0.5 * (begin + end)),
                   high = 65535 * curved(end);
      pieces_[i] = {low, 4 * middle - 3 * low - high, 2 * (low + high) - 4 * middle};
    }
  }
  /// \returns the value, with an error of at most 1e-4.
  [[nodiscard]] double operator()(float linear) const {
    const auto bits = bits_as<std::uint32_t>(linear);
    const Piece& piece = pieces_[(bits >> 16) - kFirst];
    const double t = double(bits & 0xFFFFu) * (1.0 / 65536);
    return piece.at_start + t * (piece.slope + t * piece.bend);
  }

 private:
  struct Piece {
    double at_start, slope, bend;
  };
  static constexpr std::uint32_t kFirst = 0x3B4D2E1Cu >> 16;  // kLinearEnd as a float

  static double start(std::size_t i) { return double(bits_as<float>((kFirst + std::uint32_t(i)) << 16)); }

  std::array<Piece, (detail::one_bits >> 16) - kFirst> pieces_;
};

}  // namespace

constexpr std::array<std::uint32_t, detail::srgb8_bucket_count> detail::srgb8_buckets = buckets();
constexpr std::array<float, 256> detail::srgb8_linears = linear_table();

double srgb_of_linear(double linear) { return linear <= kLinearEnd ? linear * 12.92 : curved(linear); }

std::uint16_t srgb16_of_linear(float linear) {
  if (!(linear > 0)) return 0;  // NaN too
  if (linear >= 1) return 65535;
  if (double(linear) > kLinearEnd) {
    // Made at the first call, as most programs write 8 bits.
    static const Parabolas parabolas;
    const double near = parabolas(linear) + 0.5, whole = double(std::uint32_t(near)), fraction = near - whole;
    // The answer is certain if the next step is farther away than the parabola's error: 499 times in 500.
    constexpr double doubt = 1e-3;
    if (fraction > doubt && fraction < 1 - doubt) return std::uint16_t(whole);
  }
  return std::uint16_t(srgb_of_linear(double(linear)) * 65535 + 0.5);
}

float linear_of_srgb16(std::uint16_t value) { return float(exact_linear_of(value / 65535.0)); }

float linear_of_srgb(float srgb) {
  const float clamped = srgb < 0 ? 0.0f : (srgb < 1 ? srgb : 1.0f);  // NaN becomes 1
  // Most files hold multiples of 1/255, which a table converts.
  const float bytes = clamped * 255.0f;
  const auto nearest = std::uint8_t(bytes + 0.5f);
  if (std::abs(bytes - float(nearest)) < 1e-3f) return linear_of_srgb8(nearest);
  return linear_of_srgb16(std::uint16_t(clamped * 65535.0f + 0.5f));
}

}  // namespace frontmost
