// SPDX-License-Identifier: Apache-2.0
// FNV-1a over words of 64 bits, with a shift after each. Without the shift, the upper bits of a word would never reach
// the lower bits of the hash, and two words could cancel each other.
#include "cli/render/file_hash.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <frontmost/base.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <vector>

#include "cli/failure.h"

namespace frontmost::cli {
namespace {

/// Adds bytes. Zeros fill up an incomplete last word; the caller adds the length.
void add_bytes(RunningHash& hash, std::span<const char> bytes) {
  std::uint64_t word = 0;
  std::size_t at = 0;
  for (; at + sizeof word <= bytes.size(); at += sizeof word) {
    std::memcpy(&word, bytes.data() + at, sizeof word);
    hash.add(word);
  }
  if (at == bytes.size()) return;
  word = 0;
  std::memcpy(&word, bytes.data() + at, bytes.size() - at);
  hash.add(word);
}

[[noreturn]] void fail_to_read(const std::string& path) {
  const int code = errno;  // before strings are made, which may change errno
  throw Error(ErrorCode::file_unreadable, path, "", "cannot read: " + std::generic_category().message(code));
}

class OpenFile {
 public:
  explicit OpenFile(const std::string& path) : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) fail_to_read(path);
  }
  ~OpenFile() { ::close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  /// Fills `block`. \returns the number of bytes read, which is smaller only at the end.
  std::size_t fill(std::span<char> block) const {
    std::size_t done = 0;
    while (done < block.size()) {
      const ssize_t got = ::read(descriptor_, block.data() + done, block.size() - done);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail_to_read(path_);
      if (got == 0) break;
      done += std::size_t(got);
    }
    return done;
  }

 private:
  const std::string& path_;
  int descriptor_;
};

}  // namespace

void RunningHash::add(std::uint64_t word) {
  value_ = (value_ ^ word) * 0x9E3779B97F4A7C15u;
  value_ ^= value_ >> 32;
}

void RunningHash::add(std::string_view text) {
  add(text.size());
  add_bytes(*this, text);
}

void RunningHash::add_bits(double number) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  add(bits);
}

FileHash hash_of_file(const std::string& path) {
  constexpr std::size_t block_size = std::size_t(1) << 20;  // a multiple of a word's size
  const OpenFile file(path);
  std::vector<char> block(block_size);
  RunningHash hash;
  FileHash result;
  for (std::size_t got = block_size; got == block_size; result.bytes += got) {
    got = file.fill(block);
    add_bytes(hash, std::span(block).first(got));
    stop_if_interrupted();
  }
  hash.add(result.bytes);
  result.hash = hash.value();
  return result;
}

std::string digits_of_hash(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace frontmost::cli
