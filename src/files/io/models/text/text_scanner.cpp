// SPDX-License-Identifier: Apache-2.0
// The two rare steps of the scanner, kept out of line so that the loops over words stay short.
#include "io/models/text/text_scanner.h"

#include "base/parallel.h"
#include "io/models/model_source.h"

namespace frontmost {

bool TextScanner::join_lines() {
  const char* p = at_ + 1;
  if (p != end_ && *p == '\r' && end_ - p > 1 && p[1] == '\n') ++p;
  if (p == end_ || (*p != '\n' && *p != '\r')) return false;
  at_ = p;
  ++line_;
  return true;
}

void TextScanner::release() {
  source_.release({reinterpret_cast<const std::byte*>(released_), std::size_t(at_ - released_)});
  released_ = at_;
  check_cancelled(source_.execution());
}

}  // namespace frontmost
