// SPDX-License-Identifier: Apache-2.0
// Output files that are complete or absent: written beside their place without a name, and named when complete.
//
// Several files cannot be replaced at once. StagedFolder comes as near to that as a file system allows: all files are
// first written beside their places, where a full disk is found out, and are then only renamed.
#include "base/output_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "frontmost/base.h"

namespace frontmost {
namespace {

namespace fs = std::filesystem;

/// The path at the end of a chain of symbolic links, whether or not a file is there.
fs::path follow_links(fs::path path) {
  constexpr int longest_chain = 40;  // the limit of Linux
  std::error_code ignored;
  for (int i = 0; i < longest_chain && fs::is_symlink(fs::symlink_status(path, ignored)); ++i) {
    const fs::path next = fs::read_symlink(path, ignored);
    if (next.empty()) break;
    path = path.parent_path() / next;  // an absolute `next` replaces the whole path
  }
  return path;
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

#ifdef O_TMPFILE
std::string link_of(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }
#endif

/// Tries `make` with hidden names beside `target` until one is free. \returns that name; empty with errno set on error.
template <class Make>
fs::path make_beside(const fs::path& target, Make&& make) {
  constexpr std::size_t longest_stem = 200;  // file names have 255 bytes
  const std::string stem = target.filename().string().substr(0, longest_stem);
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const fs::path name =
        folder_of(target) / ("." + stem + "." + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".tmp");
    if (make(name)) return name;
    if (errno != EEXIST) break;
  }
  return {};
}

}  // namespace

OutputFile::OutputFile(const std::string& path, Staging staging, unsigned permissions)
    : name_(path == "-"    ? "standard output"
            : path.empty() ? "''"
                           : path),
      target_(follow_links(path)),
      new_mode_(permissions) {
  if (path == "-") {
    kind_ = Kind::standard_output;
    descriptor_ = STDOUT_FILENO;
    return;
  }
  struct ::stat status {};
  errno = 0;
  const bool exists = ::stat(target_.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) fail("cannot write");
  if (exists && S_ISDIR(status.st_mode)) throw Error(ErrorCode::file_unwritable, name_, "", "is a folder");
  // Devices and pipes are written to, not replaced: /dev/null must not become a file.
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail("cannot open");
    return;
  }
  if (exists) {
    // Renaming would need no permission for the replaced file, but a file without write permission is not replaced.
    if (::access(target_.c_str(), W_OK) != 0) fail("cannot write");
    mode_ = status.st_mode & 0777;
  }
  if (!target_.has_filename()) throw Error(ErrorCode::file_unwritable, name_, "", "is not a file name");
  // A file without a name vanishes when the process ends, however it ends; a hidden file would stay behind.
  if (staging == Staging::named || !open_unnamed()) open_named();
}

OutputFile::~OutputFile() {
  if (kind_ != Kind::standard_output && descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::fail(const char* doing) const {
  // errno is read first, as making a string may change it.
  const int code = errno;
  throw Error(ErrorCode::file_unwritable, name_, "", doing + (": " + std::generic_category().message(code)));
}

bool OutputFile::open_unnamed() {
#ifdef O_TMPFILE
  descriptor_ = ::open(folder_of(target_).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, new_mode_);
  if (descriptor_ >= 0 && ::access(link_of(descriptor_).c_str(), F_OK) == 0) {
    kind_ = Kind::unnamed;
    return true;
  }
  if (descriptor_ >= 0) ::close(descriptor_);  // without /proc the file could never be named
  descriptor_ = -1;
#endif
  return false;
}

void OutputFile::open_named() {
  kind_ = Kind::named;
  temporary_ = make_beside(target_, [&](const fs::path& path) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, new_mode_);
    return descriptor_ >= 0;
  });
  if (temporary_.empty()) fail("cannot create");
}

void OutputFile::write(std::span<const std::byte> bytes) {
  constexpr std::size_t most = std::size_t(1) << 30;  // Linux takes less than 2 GiB a call
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), std::min(bytes.size(), most));
    if (written >= 0) {
      bytes = bytes.subspan(std::size_t(written));
    } else if (errno == EAGAIN) {  // a pipe that somebody made non-blocking
      pollfd ready{descriptor_, POLLOUT, 0};
      ::poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      fail("cannot write");
    }
  }
}

void OutputFile::commit() {
  if (kind_ == Kind::standard_output) return;
  // Permissions are set before the file has its name, so nobody can open the file with more permissions than the old
  // file gave.
  if (mode_ && kind_ != Kind::direct && ::fchmod(descriptor_, *mode_) != 0) fail("cannot set permissions");
  if (kind_ == Kind::unnamed) give_name();
  // Some file systems report only now that the disk is full.
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail("cannot write");
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot replace");
  temporary_.clear();
}

/// Links the nameless file to its place. If a file is there, links the new file to a name from which it can be renamed,
/// because links never replace a file.
void OutputFile::give_name() {
#ifdef O_TMPFILE
  const std::string source = link_of(descriptor_);
  const auto link_to = [&](const fs::path& path) {
    return ::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
  };
  // Link directly if nothing was at the place; a file that has come there meanwhile is replaced below.
  if (!mode_ && link_to(target_)) return;
  temporary_ = make_beside(target_, link_to);
  if (temporary_.empty()) fail("cannot create");
#endif
}

void save_text(std::string_view text, const std::string& path) {
  OutputFile file(path);
  file.write(std::as_bytes(std::span(text.data(), text.size())));
  file.commit();
}

MadeFolder::MadeFolder(const std::string& folder) {
  std::error_code error;
  for (fs::path path = fs::path(folder).lexically_normal(); !path.empty() && !fs::exists(path, error);
       path = path.parent_path())
    made_.insert(made_.begin(), path);
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder, error))
    throw Error(ErrorCode::file_unwritable, folder, "", "cannot be made into a folder");
}

MadeFolder::~MadeFolder() {
  std::error_code ignored;
  std::for_each(made_.rbegin(), made_.rend(), [&](const fs::path& path) { fs::remove(path, ignored); });
}

StagedFolder::StagedFolder(const std::string& folder) : folder_(folder) {
  std::string name = (folder_ / ".frontmost-XXXXXX").string();
  if (!::mkdtemp(name.data())) {
    const int code = errno;  // read first, because making strings may change it
    throw Error(ErrorCode::file_unwritable, folder, "", "cannot write: " + std::generic_category().message(code));
  }
  staged_ = name;
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(staged_, ignored);
}

std::string StagedFolder::told(const std::string& path) const {
  const std::string staged = staged_.string();
  return path.starts_with(staged) ? folder_.string() + path.substr(staged.size()) : path;
}

void StagedFolder::commit(const std::vector<std::string>& names) const {
  const auto fail = [](const fs::path& place, const std::string& why) {
    throw Error(ErrorCode::file_unwritable, place.string(), "", "cannot replace: " + why);
  };
  std::error_code unknown;
  for (const std::string& name : names)
    if (fs::is_directory(folder_ / name, unknown)) fail(folder_ / name, "it is a folder");
  for (const std::string& name : names) {
    std::error_code error;
    const fs::path place = folder_ / name, linked = fs::canonical(place, error);
    const fs::path target = error ? place : linked;
    if (!error) fs::permissions(staged_ / name, fs::status(target).permissions(), error);
    fs::rename(staged_ / name, target, error);
    if (error) fail(place, error.message());
  }
}

}  // namespace frontmost
