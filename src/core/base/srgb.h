// SPDX-License-Identifier: Apache-2.0
// The sRGB transfer function (IEC 61966-2-1), exact and the same on every machine: it uses only operations that IEEE
// 754 rounds correctly, never pow.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/memory.h"

namespace frontmost {

/// The sRGB value in [0, 1] of a linear value in [0, 1], to about 1e-15.
[[nodiscard]] double srgb_of_linear(double linear);

namespace detail {

inline constexpr float least_srgb8 = 1.0f / 8192;  ///< 2^-13, a value that still becomes byte 0
inline constexpr std::uint32_t least_srgb8_bits = 0x39000000u;
inline constexpr std::uint32_t one_bits = 0x3F800000u;
inline constexpr std::size_t srgb8_bucket_count = ((one_bits - least_srgb8_bits) >> 16) + 1;

/// One entry for 65536 neighbouring floats: see srgb.cpp.
extern const std::array<std::uint32_t, srgb8_bucket_count> srgb8_buckets;
extern const std::array<float, 256> srgb8_linears;

}  // namespace detail

/// The nearest byte: round(255 * sRGB(linear)). Values outside [0, 1] are clamped, NaN gives 0.
[[nodiscard]] inline std::uint8_t srgb8_of_linear(float linear) {
  const float above = linear > detail::least_srgb8 ? linear : detail::least_srgb8;  // false for NaN
  const float clamped = above < 1.0f ? above : 1.0f;
  const auto bits = bits_as<std::uint32_t>(clamped);
  const std::uint32_t entry = detail::srgb8_buckets[(bits - detail::least_srgb8_bits) >> 16];
  return std::uint8_t((entry + (bits & 0xFFFFu)) >> 16);
}

/// The linear value of an sRGB byte, rounded to float.
[[nodiscard]] inline float linear_of_srgb8(std::uint8_t value) { return detail::srgb8_linears[value]; }

/// The nearest 16-bit value: round(65535 * sRGB(linear)). Slower: about 3 ns a value.
[[nodiscard]] std::uint16_t srgb16_of_linear(float linear);
[[nodiscard]] float linear_of_srgb16(std::uint16_t value);

/// The linear value of an sRGB value, which is rounded to 16 bits. Values outside [0, 1] are clamped. NaN gives 1, so
/// that an undefined colour of a file changes nothing.
[[nodiscard]] float linear_of_srgb(float srgb);

}  // namespace frontmost
