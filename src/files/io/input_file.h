// SPDX-License-Identifier: Apache-2.0
// Bytes in: whole files and standard input, without holding more of them in memory than needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace frontmost {

/// Largest file that is accepted, and largest stream (standard input, pipes), which must be held in memory.
inline constexpr std::uint64_t max_file_bytes = std::uint64_t(1) << 40;
inline constexpr std::uint64_t max_stream_bytes = std::uint64_t(1) << 34;
/// Largest amount that is read from a device such as a terminal: /dev/zero never ends.
inline constexpr std::uint64_t max_device_bytes = std::uint64_t(1) << 26;

/// The bytes of one file, read only, for as long as the object lives.
///
/// Ordinary files are mapped, so that their pages come and go as readers pass over them. The price is that a file cut
/// short by another program during reading ends the process, as with every program that maps files; files below
/// `mapping_threshold`, which are most of those that people edit, are copied.
class InputFile {
 public:
  static constexpr std::uint64_t mapping_threshold = 1 << 16;

  /// `name` stands for the file in messages. \throws Error file_unreadable or limit_exceeded.
  static InputFile open(const std::filesystem::path& path, const std::string& name,
                        std::uint64_t max_bytes = max_file_bytes);
  static InputFile standard_input(const std::string& name, std::uint64_t max_bytes = max_stream_bytes);

  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

  /// Says that `part` of bytes() will hardly be read again, so that its memory can be used for something else.
  /// Its contents stay valid.
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

/// Bytes as text, without a UTF-8 byte order mark at their start. Every reader of text takes its bytes through this.
[[nodiscard]] std::string_view text_of(std::span<const std::byte> bytes);

/// \throws Error file_unreadable: "name: reason".
[[noreturn]] void fail_to_read(const std::string& name, const std::string& reason);
/// The same with the system's words for errno, which must not have changed since the call that failed.
[[noreturn]] void fail_to_read_by_errno(const std::string& name, const char* doing);

}  // namespace frontmost
