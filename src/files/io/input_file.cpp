// SPDX-License-Identifier: Apache-2.0
// A whole file is mapped if that pays off, else read, with a limit that is checked before memory is allocated.
#include "io/input_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "frontmost/files.h"
#include "io/descriptor.h"

namespace frontmost {
namespace {

void check_size(std::uint64_t size, std::uint64_t max_bytes, const std::string& name) {
  if (size > max_bytes)
    throw Error(ErrorCode::limit_exceeded, name, "",
                "larger than the limit of " + std::to_string(max_bytes) + " bytes");
}

int open_for_reading(const char* path, const std::string& name) {
  const int descriptor = ::open(path, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail_to_read_by_errno(name, "cannot open");
  return descriptor;
}

struct ::stat status_of(int descriptor, const std::string& name) {
  struct ::stat status {};
  if (::fstat(descriptor, &status) != 0) fail_to_read_by_errno(name, "cannot read");
  if (S_ISDIR(status.st_mode)) fail_to_read(name, "is a folder");
  return status;
}

/// Reads up to `count` bytes; an interrupting signal is no error. \returns the number of bytes read: 0 only at the end.
std::size_t read_some(int descriptor, std::byte* to, std::size_t count, const std::string& name) {
  for (;;) {
    const ssize_t got = ::read(descriptor, to, count);
    if (got >= 0) return std::size_t(got);
    if (errno != EINTR) fail_to_read_by_errno(name, "cannot read");
  }
}

}  // namespace

void InputFile::Delete::operator()(const std::byte* data) const {
  auto* start = const_cast<std::byte*>(data);
  if (mapped_size == 0)
    std::free(start);
  else
    ::munmap(start, mapped_size);
}

InputFile InputFile::open(const std::filesystem::path& path, const std::string& name, std::uint64_t max_bytes) {
  const int number = open_for_reading(path.c_str(), name);
  const Descriptor file(number);
  const struct ::stat status = status_of(number, name);
  // Pipes have no size, and files of /proc report 0.
  const auto size = std::uint64_t(std::max<off_t>(status.st_size, 0));
  if (!S_ISREG(status.st_mode) || size < mapping_threshold)
    return read_stream(number, name, std::min(max_bytes, max_stream_bytes));
  check_size(size, max_bytes, name);
  const auto bytes = std::size_t(size);
  void* start = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, number, 0);
  if (start == MAP_FAILED) fail_to_read_by_errno(name, "cannot map");
  ::madvise(start, bytes, MADV_SEQUENTIAL);  // only advice
  return {Data(static_cast<const std::byte*>(start), Delete{bytes}), bytes};
}

InputFile InputFile::open_input(const std::string& path, std::uint64_t max_bytes) {
  if (path != "-") return open(path, path, max_bytes);
  return read_stream(STDIN_FILENO, input_name(path), std::min(max_bytes, max_stream_bytes));
}

InputFile InputFile::read_stream(int descriptor, const std::string& name, std::uint64_t max_bytes) {
  struct ::stat status {};
  if (::fstat(descriptor, &status) == 0 && (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)))
    // /dev/zero has no end, and would fill the memory up to any limit that suits models.
    max_bytes = std::min(max_bytes, max_device_bytes);
  // realloc moves large blocks by remapping pages, so growth needs no second copy.
  std::size_t capacity = mapping_threshold, size = 0;
  auto* start = static_cast<std::byte*>(std::malloc(capacity));
  Data data(start, Delete{});
  while (start != nullptr) {
    if (size == capacity) {
      // The file may end exactly here, so check_size() is asked about one byte more before the buffer grows.
      check_size(size + 1, max_bytes, name);
      capacity *= 2;
      start = static_cast<std::byte*>(std::realloc(start, capacity));
      if (start == nullptr) break;
      // realloc has freed or moved the old block, which must not be freed again.
      (void)data.release();
      data.reset(start);
    }
    const std::size_t got = read_some(descriptor, start + size, capacity - size, name);
    if (got == 0) break;
    size += got;
  }
  if (start == nullptr) throw std::bad_alloc();
  check_size(size, max_bytes, name);
  return {std::move(data), size};
}

void InputFile::release(std::span<const std::byte> part) const {
  if (data_.get_deleter().mapped_size == 0 || part.empty()) return;
  // Only whole pages within the part are released; the mapping itself starts at a page.
  static const auto page = std::size_t(::sysconf(_SC_PAGESIZE));
  const auto first = std::size_t(part.data() - data_.get());
  const std::size_t begin = (first + page - 1) / page * page;
  const std::size_t end = (first + part.size()) / page * page;
  if (begin < end) ::madvise(const_cast<std::byte*>(data_.get()) + begin, end - begin, MADV_DONTNEED);
}

ByteStream::ByteStream(const std::string& path, std::string name) : name_(std::move(name)) {
  is_ours_ = path != "-";
  descriptor_ = is_ours_ ? open_for_reading(path.c_str(), name_) : STDIN_FILENO;
  const struct ::stat status = status_of(descriptor_, name_);
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
  // A pipe may return fewer bytes than asked for before its end.
  for (std::size_t got = 1; done < count && got > 0; done += got)
    got = read_some(descriptor_, to + done, count - done, name_);
  return done;
}

void ByteStream::seek(std::uint64_t offset) {
  if (::lseek(descriptor_, off_t(offset), SEEK_SET) < 0) fail_to_read_by_errno(name_, "cannot read again");
}

std::string input_name(const std::string& path) { return path == "-" ? "standard input" : path; }

std::string lower_suffix(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  for (char& c : suffix)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return suffix;
}

std::string_view text_of(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

std::string load_text(const std::string& path, std::uint64_t most_bytes) {
  return std::string(text_of(InputFile::open_input(path, most_bytes).bytes()));
}

void fail_to_read(const std::string& name, const std::string& reason) {
  throw Error(ErrorCode::file_unreadable, name, "", reason);
}

void fail_to_read_by_errno(const std::string& name, const char* doing) {
  const int code = errno;  // before strings are made, which may change errno
  fail_to_read(name, std::string(doing) + ": " + std::generic_category().message(code));
}

}  // namespace frontmost
