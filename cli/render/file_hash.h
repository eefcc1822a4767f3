// SPDX-License-Identifier: Apache-2.0
// Hashes of files, texts and numbers, for telling whether what was made is what would be made again.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace frontmost::cli {

/// 64 bits of all that was added, in this order. Not for secrets: collisions can be made on purpose.
class RunningHash {
 public:
  void add(std::uint64_t word);
  /// With its length, so that "ab", "c" is not "a", "bc".
  void add(std::string_view text);
  void add_bits(double number);
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// A file by its length and its bytes.
struct FileHash {
  std::uint64_t bytes = 0, hash = 0;
  [[nodiscard]] bool operator==(const FileHash&) const = default;
};
/// \throws Error file_unreadable.
[[nodiscard]] FileHash hash_of_file(const std::string& path);

/// 16 digits: JSON's numbers lose bits above 2^53 in many readers.
[[nodiscard]] std::string digits_of_hash(std::uint64_t hash);

}  // namespace frontmost::cli
