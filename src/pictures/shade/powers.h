// SPDX-License-Identifier: Apache-2.0
// Powers of two and logarithms from + - * / and the bits of floats alone: every machine gives the same results, and
// loops over lanes vectorize. The relative error is below 1e-6.
//
//   2^x     whole part of x --> exponent      rest, -1/2 to 1/2 --> series of the exponential function
//   log2    exponent                          mantissa, 0.7 to 1.4 --> series of the inverse hyperbolic tangent
#pragma once

#include <cstdint>
#include <cstring>

namespace frontmost::shading {

/// Returns 2^x, clamped to the range of normal floats.
[[nodiscard]] inline float exp2_of(float x) {
  x = x > -126.0f ? x : -126.0f;  // for NaN, too
  x = x < 126.0f ? x : 126.0f;
  const auto whole = std::int32_t(x + 126.5f) - 126;  // truncated: positive
  const float rest = x - float(whole);
  float series = 1.5252734e-5f;
  series = series * rest + 1.5403530e-4f;
  series = series * rest + 1.3333558e-3f;
  series = series * rest + 9.6181291e-3f;
  series = series * rest + 5.5504109e-2f;
  series = series * rest + 2.4022651e-1f;
  series = series * rest + 6.9314718e-1f;
  series = series * rest + 1.0f;
  const std::int32_t bits = (whole + 127) * (1 << 23);
  float power;
  std::memcpy(&power, &bits, sizeof power);
  return series * power;
}

/// Returns the binary logarithm. Precondition: x is a normal positive number.
[[nodiscard]] inline float log2_of(float x) {
  std::int32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  // A mantissa above the square root of 2 belongs to the next exponent.
  const std::int32_t exponent = (bits - 0x3F3504F3) >> 23;
  const std::int32_t mantissa_bits = bits - exponent * (1 << 23);
  float mantissa;
  std::memcpy(&mantissa, &mantissa_bits, sizeof mantissa);
  const float s = (mantissa - 1.0f) / (mantissa + 1.0f), s2 = s * s;
  float series = 0.41219859f;
  series = series * s2 + 0.57707802f;
  series = series * s2 + 0.96179669f;
  series = series * s2 + 2.8853901f;
  return float(exponent) + series * s;
}

}  // namespace frontmost::shading
