// SPDX-License-Identifier: Apache-2.0
// Reads numbers from the bytes of binary files, in either byte order and at any alignment, and writes them in
// little-endian order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>

#include "base/output_file.h"
#include "frontmost/files.h"

namespace frontmost {

enum class Endian : std::uint8_t { little, big };

inline constexpr Endian native_endian = std::endian::native == std::endian::little ? Endian::little : Endian::big;

/// Returns the value whose bytes start at `from`.
template <class T>
[[nodiscard]] T read_value(const std::byte* from, Endian endian) {
  std::byte bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof(T));
  if (endian != native_endian) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

namespace detail {

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

/// Appends one number of a column.
inline void append_bytes(std::string& bytes, const TableColumn& column, std::size_t row) {
  if (const auto* small = std::get_if<std::vector<std::uint8_t>>(&column.values))
    bytes += char((*small)[row]);
  else if (const auto* words = std::get_if<std::vector<std::uint32_t>>(&column.values))
    append_bytes(bytes, (*words)[row]);
  else
    append_bytes(bytes, std::get<std::vector<double>>(column.values)[row]);
}

/// Collects small pieces of a file and writes them in large blocks.
class FileBytes {
 public:
  explicit FileBytes(OutputFile& file) : file_(file) {}

  /// Returns the bytes that are not written yet. Callers may append to them.
  [[nodiscard]] std::string& bytes() { return bytes_; }
  /// Writes the collected bytes if there are enough of them. To be called after each piece.
  void pass_on() {
    if (bytes_.size() >= bytes_at_once) finish();
  }
  void finish() {
    file_.write(std::as_bytes(std::span(bytes_)));
    bytes_.clear();
  }

 private:
  static constexpr std::size_t bytes_at_once = 1 << 20;
  OutputFile& file_;
  std::string bytes_;
};

}  // namespace detail
}  // namespace frontmost
