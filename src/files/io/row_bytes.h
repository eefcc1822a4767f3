// SPDX-License-Identifier: Apache-2.0
// Numbers as bytes of binary files, little-endian on every machine.
#pragma once

#include <cstring>
#include <string>

#include "frontmost/files.h"

namespace frontmost::detail {

inline void append_bytes(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += char(word >> shift & 0xFF);
}

inline void append_bytes(std::string& bytes, float value) {
  std::uint32_t word;
  std::memcpy(&word, &value, sizeof word);
  append_bytes(bytes, word);
}

inline void append_bytes(std::string& bytes, double value) {
  std::uint64_t word;
  std::memcpy(&word, &value, sizeof word);
  append_bytes(bytes, std::uint32_t(word));
  append_bytes(bytes, std::uint32_t(word >> 32));
}

/// One number of a column.
inline void append_bytes(std::string& bytes, const TableColumn& column, std::size_t row) {
  if (const auto* small = std::get_if<std::vector<std::uint8_t>>(&column.values))
    bytes += char((*small)[row]);
  else if (const auto* words = std::get_if<std::vector<std::uint32_t>>(&column.values))
    append_bytes(bytes, (*words)[row]);
  else
    append_bytes(bytes, std::get<std::vector<double>>(column.values)[row]);
}

}  // namespace frontmost::detail
