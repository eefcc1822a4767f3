// SPDX-License-Identifier: Apache-2.0
// Hashes of files, texts and numbers, to detect changes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace frontmost::cli {

/// A 64-bit hash of all added values, in order. It is not for security, because collisions can be constructed.
class RunningHash {
 public:
  void add(std::uint64_t word);
  /// Adds the text with its length, so that "ab", "c" differs from "a", "bc".
  void add(std::string_view text);
  void add_bits(double number);
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// Length and hash of a file.
struct FileHash {
  std::uint64_t bytes = 0, hash = 0;
  [[nodiscard]] bool operator==(const FileHash&) const = default;
};
/// Returns the length and hash of a file. \throws Error file_unreadable.
[[nodiscard]] FileHash hash_of_file(const std::string& path);

/// Returns the hash as 16 hexadecimal digits, because JSON numbers above 2^53 lose bits in many readers.
[[nodiscard]] std::string digits_of_hash(std::uint64_t hash);

}  // namespace frontmost::cli
