// SPDX-License-Identifier: Apache-2.0
// Small pieces of a file brought together, and written when they are many.
#pragma once

#include "base/output_file.h"
#include "io/row_bytes.h"

namespace frontmost::detail {

class FileBytes {
 public:
  explicit FileBytes(OutputFile& file) : file_(file) {}

  /// What has come together; may be added to.
  [[nodiscard]] std::string& bytes() { return bytes_; }
  /// After each piece.
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
