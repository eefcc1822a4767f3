// SPDX-License-Identifier: Apache-2.0
// Bytes in, from front to back, of files that need not fit into memory.
//
// InputFile maps a file as a whole, which suits readers that go back and forth; a ByteStream reads on and on, which
// suits pipes and models longer than memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace frontmost {

/// An open file, pipe or standard input. Files are read, not mapped: what is held of them is what the caller holds, and
/// a file cut short by another program is an end, not a signal.
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

  /// Of an ordinary file; none of a pipe or a terminal.
  [[nodiscard]] std::optional<std::uint64_t> size() const { return size_; }
  [[nodiscard]] bool can_rewind() const { return size_.has_value(); }
  /// The next byte read is the one at `offset`. Precondition: can_rewind().
  void seek(std::uint64_t offset);

 private:
  std::string name_;
  int descriptor_ = -1;
  bool is_ours_ = false;
  std::optional<std::uint64_t> size_;
};

}  // namespace frontmost
