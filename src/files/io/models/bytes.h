// SPDX-License-Identifier: Apache-2.0
// Numbers out of bytes, in either byte order, at any alignment.
//
// The formats that are read have both orders, and put numbers wherever they fall: behind a header of any length, in
// records of 50 bytes. So bytes are copied into the number, and turned round where the machine's order is the other
// one.
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
