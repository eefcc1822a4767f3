// SPDX-License-Identifier: Apache-2.0
// What a file that cannot be read throws.
#pragma once

#include <string>

namespace frontmost {

/// \throws Error file_unreadable: "name: reason".
[[noreturn]] void fail_to_read(const std::string& name, const std::string& reason);
/// The same with the system's words for errno, which must not have changed since the call that failed.
[[noreturn]] void fail_to_read_by_errno(const std::string& name, const char* doing);

}  // namespace frontmost
