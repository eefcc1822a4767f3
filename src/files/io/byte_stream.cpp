// SPDX-License-Identifier: Apache-2.0
// Reads a file or a pipe once from begin to end, and again if it can be rewound.

#include "io/byte_stream.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "frontmost/base.h"
#include "io/input_file.h"

namespace frontmost {
ByteStream::ByteStream(const std::string& path, std::string name) : name_(std::move(name)) {
  is_ours_ = path != "-";
  descriptor_ = is_ours_ ? ::open(path.c_str(), O_RDONLY | O_CLOEXEC) : STDIN_FILENO;
  if (descriptor_ < 0) fail_to_read_by_errno(name_, "cannot open");
  struct ::stat status {};
  if (::fstat(descriptor_, &status) != 0) fail_to_read_by_errno(name_, "cannot read");
  if (S_ISDIR(status.st_mode)) fail_to_read(name_, "is a folder");
  // The size of files in /proc is 0 though they have contents. Standard input may be a file that was read in part.
  const bool is_at_start = ::lseek(descriptor_, 0, SEEK_CUR) == 0;
  if (S_ISREG(status.st_mode) && status.st_size > 0 && is_at_start) size_ = std::uint64_t(status.st_size);
  if (size_) ::posix_fadvise(descriptor_, 0, 0, POSIX_FADV_SEQUENTIAL);  // only advice
}

ByteStream::~ByteStream() {
  if (is_ours_) ::close(descriptor_);
}

std::size_t ByteStream::read(std::byte* to, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::read(descriptor_, to + done, count - done);
    // An interrupting signal is no error.
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail_to_read_by_errno(name_, "cannot read");
    // A pipe may return fewer bytes than asked for before its end; only zero bytes mean the end.
    if (got == 0) break;
    done += std::size_t(got);
  }
  return done;
}

void ByteStream::seek(std::uint64_t offset) {
  if (::lseek(descriptor_, off_t(offset), SEEK_SET) < 0) fail_to_read_by_errno(name_, "cannot read again");
}

}  // namespace frontmost
