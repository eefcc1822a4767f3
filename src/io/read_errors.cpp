// SPDX-License-Identifier: Apache-2.0
#include "io/read_errors.h"

#include <cerrno>
#include <system_error>

#include "frontmost/base.h"

namespace frontmost {

void fail_to_read(const std::string& name, const std::string& reason) {
  throw Error(ErrorCode::file_unreadable, name + ": " + reason);
}

void fail_to_read_by_errno(const std::string& name, const char* doing) {
  const int code = errno;  // before strings are made: that may change it
  fail_to_read(name, std::string(doing) + ": " + std::generic_category().message(code));
}

}  // namespace frontmost
