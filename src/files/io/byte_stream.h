// SPDX-License-Identifier: Apache-2.0
// Sequential input of files that need not fit into memory.
//
// InputFile maps a whole file, for readers that go back and forth. ByteStream reads forwards, for pipes and for models
// larger than memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace frontmost {

/// An open file, pipe or standard input. The stream reads and does not map files: only the caller's buffers take
/// memory, and a file cut short by another program causes an early end instead of a signal.
class ByteStream {
 public:
  /// "-" is standard input. `name` stands for the file in messages. \throws Error file_unreadable.
  ByteStream(const std::string& path, std::string name);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Fills `to` with the next `count` bytes. \returns how many there were; fewer only at the end.
  /// \throws Error file_unreadable.
  std::size_t read(std::byte* to, std::size_t count);

  /// The size of an ordinary file; empty for a pipe or a terminal.
  [[nodiscard]] std::optional<std::uint64_t> size() const { return size_; }
  [[nodiscard]] bool can_rewind() const { return size_.has_value(); }
  /// Moves to `offset`, from which the next byte is read. Precondition: can_rewind().
  void seek(std::uint64_t offset);

 private:
  std::string name_;
  int descriptor_ = -1;
  bool is_ours_ = false;
  std::optional<std::uint64_t> size_;
};

}  // namespace frontmost
