// SPDX-License-Identifier: Apache-2.0
// Input of whole files and of standard input, with no more bytes in memory than needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace frontmost {

/// Greatest size of a file, and of a stream (standard input, pipes), which must be held in memory.
inline constexpr std::uint64_t max_file_bytes = std::uint64_t(1) << 40;
inline constexpr std::uint64_t max_stream_bytes = std::uint64_t(1) << 34;
/// Greatest number of bytes that are read from a device, for example a terminal: /dev/zero never ends.
inline constexpr std::uint64_t max_device_bytes = std::uint64_t(1) << 26;

/// The bytes of one file, read only; valid during the object's lifetime.
///
/// Ordinary files are mapped, so that the system loads and drops their pages as readers pass over them. A mapped file
/// that another program cuts short during reading ends the process. Files below `mapping_threshold`, which include most
/// that people edit, are copied.
class InputFile {
 public:
  static constexpr std::uint64_t mapping_threshold = 1 << 16;

  /// `name` stands for the file in messages. \throws Error file_unreadable or limit_exceeded.
  static InputFile open(const std::filesystem::path& path, const std::string& name,
                        std::uint64_t max_bytes = max_file_bytes);
  static InputFile standard_input(const std::string& name, std::uint64_t max_bytes = max_stream_bytes);

  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

  /// Tells that `part` of bytes() will hardly be read again, so that its memory can be reused. Its contents stay valid.
  void release(std::span<const std::byte> part) const;

 private:
  enum class Owner : std::uint8_t { heap, mapping };
  struct Delete {
    Owner owner = Owner::heap;
    std::size_t size = 0;
    void operator()(const std::byte* data) const;
  };
  using Data = std::unique_ptr<const std::byte[], Delete>;

  InputFile(Data data, std::size_t size) : data_(std::move(data)), size_(size) {}
  static InputFile read_stream(int descriptor, const std::string& name, std::uint64_t max_bytes);
  static InputFile map(int descriptor, std::size_t size, const std::string& name);

  Data data_;
  std::size_t size_ = 0;
};

/// Bytes as text, without a UTF-8 byte order mark at their start. All readers of text call this function.
[[nodiscard]] std::string_view text_of(std::span<const std::byte> bytes);

/// \throws Error file_unreadable: "name: reason".
[[noreturn]] void fail_to_read(const std::string& name, const std::string& reason);
/// \throws Error file_unreadable with the system's text for errno. Precondition: errno is unchanged since the failed
/// call.
[[noreturn]] void fail_to_read_by_errno(const std::string& name, const char* doing);

}  // namespace frontmost
