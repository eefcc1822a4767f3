// SPDX-License-Identifier: Apache-2.0
// Collects small pieces of a file and writes them in large blocks.
#pragma once

#include "base/output_file.h"
#include "io/row_bytes.h"

namespace frontmost::detail {

class FileBytes {
 public:
  explicit FileBytes(OutputFile& file) : file_(file) {}

  /// The bytes collected so far; callers may append.
  [[nodiscard]] std::string& bytes() { return bytes_; }
  /// Writes the collected bytes if there are enough of them. Call after each piece.
  void pass_on() {
    if (bytes_.size() >= kBytesAtOnce) finish();
  }
  void finish() {
    file_.write(std::as_bytes(std::span(bytes_)));
    bytes_.clear();
  }

 private:
  static constexpr std::size_t kBytesAtOnce = 1 << 20;
  OutputFile& file_;
  std::string bytes_;
};

}  // namespace frontmost::detail
