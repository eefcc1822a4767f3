// SPDX-License-Identifier: Apache-2.0
// Reads numbers from bytes, in either byte order, at any alignment.
//
// Model formats use both byte orders and place numbers at any address: behind headers of any length, in records of 50
// bytes. So bytes are copied into a number, and reversed if the machine has the other order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

namespace frontmost {

enum class Endian : std::uint8_t { little, big };

inline constexpr Endian native_endian = std::endian::native == std::endian::little ? Endian::little : Endian::big;

/// The value whose bytes start at `from`.
template <class T>
[[nodiscard]] T read_value(const std::byte* from, Endian endian) {
  std::byte bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof(T));
  if (endian != native_endian) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

}  // namespace frontmost
