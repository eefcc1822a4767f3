// SPDX-License-Identifier: Apache-2.0
// Files of numbers, a few on every line.
#pragma once

#include <string>
#include <vector>

namespace frontmost::cli {

/// How many numbers a line holds, and why, as complaints say it: "six numbers make a pair of points".
struct LineRule {
  std::size_t count;
  const char* text;
};

/// The numbers of all lines that hold any, one line after the other; # starts a comment.
/// \throws Error file_unreadable; file_malformed naming the line; limit_exceeded for more than 1 GiB or 2^22 such
/// lines.
[[nodiscard]] std::vector<double> read_number_lines(const std::string& path, const LineRule& rule);

}  // namespace frontmost::cli
