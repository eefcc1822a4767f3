// SPDX-License-Identifier: Apache-2.0
#include "import/answer.h"

#include <link.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace frontmost::import {

void Answer::progress(double done) {
  constexpr double step = 0.01;
  if (done < told_ + step) return;
  told_ = done;
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%.2f", done);
  write(import_frames::Kind::progress, {text, std::size_t(length)});
}

void Answer::space(double metres, std::string_view up) {
  char text[64];
  const int length =
      metres > 0 ? std::snprintf(text, sizeof text, "%.17g ", metres) : std::snprintf(text, sizeof text, "- ");
  write(import_frames::Kind::space, std::string(text, std::size_t(length)).append(up));
}

void Answer::files() {
  const auto add = [](dl_phdr_info* loaded, std::size_t, void* answer) {
    const std::string_view path = loaded->dlpi_name;
    // The program itself has no name here; the kernel's part is no file.
    if (path.starts_with('/')) static_cast<Answer*>(answer)->write_text(import_frames::Kind::file, path);
    return 0;
  };
  std::error_code unknown;
  write_text(import_frames::Kind::file, std::filesystem::read_symlink("/proc/self/exe", unknown).string());
  dl_iterate_phdr(add, this);
}

void Answer::write(import_frames::Kind kind, std::string_view payload) {
  const import_frames::Header header = import_frames::header_of(kind, payload.size());
  for (std::string_view left : {std::string_view(reinterpret_cast<const char*>(header.data()), header.size()), payload})
    while (!left.empty()) {
      const ssize_t written = ::write(descriptor_, left.data(), left.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) std::_Exit(1);  // nobody reads the answer any more
      left.remove_prefix(std::size_t(written));
    }
}

}  // namespace frontmost::import
