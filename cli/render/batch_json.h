// SPDX-License-Identifier: Apache-2.0
// The text of a batch file as JSON, checked against limits before anything is kept of it.
#pragma once

#include <string>

#include "cli/json.h"

namespace frontmost::cli {

/// O(size of the text). \throws UsageError naming file and line for what is not JSON, and for a number that no double
/// holds; naming the file for more than 100,000 views, 8,000,000 values or 256 keys of an object, or lists in lists.
[[nodiscard]] Json parse_batch_json(const std::string& text, const std::string& name);

}  // namespace frontmost::cli
