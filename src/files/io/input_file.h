// SPDX-License-Identifier: Apache-2.0
// Input of files, pipes and standard input: whole files in memory, or forwards piece by piece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace frontmost {

/// Greatest size of a file, and of a stream (standard input or a pipe), which cannot be mapped and fills memory.
inline constexpr std::uint64_t max_file_bytes = std::uint64_t(1) << 40;
inline constexpr std::uint64_t max_stream_bytes = std::uint64_t(1) << 34;
/// Greatest number of bytes that are read from a device, for example a terminal: /dev/zero never ends.
inline constexpr std::uint64_t max_device_bytes = std::uint64_t(1) << 26;

/// The bytes of one file. They can be read during the object's lifetime, and not changed.
///
/// Ordinary files are mapped, so that the system loads and drops their pages as readers pass over them. A mapped file
/// that another program cuts short during reading ends the process. Files below `mapping_threshold`, which include most
/// that people edit, are copied.
class InputFile {
 public:
  static constexpr std::uint64_t mapping_threshold = 1 << 16;

  /// Opens `path`. `name` stands for the file in messages. \throws Error file_unreadable or limit_exceeded.
  static InputFile open(const std::filesystem::path& path, const std::string& name,
                        std::uint64_t max_bytes = max_file_bytes);
  /// Opens a path that a user gave: "-" is standard input. Otherwise like open().
  static InputFile open_input(const std::string& path, std::uint64_t max_bytes = max_file_bytes);

  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

  /// Tells that `part` of bytes() will hardly be read again, so that its memory can be reused. Its contents stay valid.
  void release(std::span<const std::byte> part) const;

 private:
  struct Delete {
    std::size_t mapped_size = 0;  ///< 0: on the heap
    void operator()(const std::byte* data) const;
  };
  using Data = std::unique_ptr<const std::byte[], Delete>;

  InputFile(Data data, std::size_t size) : data_(std::move(data)), size_(size) {}
  static InputFile read_stream(int descriptor, const std::string& name, std::uint64_t max_bytes);
  static InputFile map(int descriptor, std::size_t size, const std::string& name);

  Data data_;
  std::size_t size_ = 0;
};

/// Sequential input of a file, a pipe or standard input. The stream does not map files: only the caller's buffers take
/// memory, and a file cut short by another program causes an early end instead of a signal.
class ByteStream {
 public:
  /// Opens `path`. The path "-" stands for standard input. Messages call the file `name`. \throws Error
  /// file_unreadable.
  ByteStream(const std::string& path, std::string name);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Fills `to` with the next `count` bytes. \returns the number of bytes read, which is less than `count` only at the
  /// end. \throws Error file_unreadable.
  std::size_t read(std::byte* to, std::size_t count);

  /// Returns the size of an ordinary file, or nothing for a pipe or a terminal.
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

/// Returns the name of an input in messages: its path, or "standard input" for "-".
[[nodiscard]] std::string input_name(const std::string& path);

/// Returns the suffix of a file's name, in lower case and with its point.
[[nodiscard]] std::string lower_suffix(const std::string& path);

/// Returns bytes as text, without a UTF-8 byte order mark at their start. All readers of text call this function.
[[nodiscard]] std::string_view text_of(std::span<const std::byte> bytes);

/// \throws Error file_unreadable: "name: reason".
[[noreturn]] void fail_to_read(const std::string& name, const std::string& reason);
/// \throws Error file_unreadable with the system's text for errno. Precondition: errno is unchanged since the failed
/// call.
[[noreturn]] void fail_to_read_by_errno(const std::string& name, const char* doing);

}  // namespace frontmost
