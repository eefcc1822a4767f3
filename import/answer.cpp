// SPDX-License-Identifier: Apache-2.0
#include "import/answer.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

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

void Answer::write(import_frames::Kind kind, std::string_view payload) {
  std::string header(1, char(kind));
  for (std::size_t i = 1; i < import_frames::header_bytes; ++i) header += char(payload.size() >> 8 * (i - 1) & 255);
  for (std::string_view left : {std::string_view(header), payload})
    while (!left.empty()) {
      const ssize_t written = ::write(descriptor_, left.data(), left.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) std::_Exit(1);  // nobody reads the answer any more
      left.remove_prefix(std::size_t(written));
    }
}

}  // namespace frontmost::import
