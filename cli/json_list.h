// SPDX-License-Identifier: Apache-2.0
// JSON that is printed while it is made.
#pragma once

#include <string>

#include "cli/json_numbers.h"

namespace frontmost::cli {

/// Prints an object that holds a long list, an element at a time: the text that dump() makes of the whole, without ever
/// holding it.
class JsonListPrinter {
 public:
  /// `before` are the members before the list, at least one.
  JsonListPrinter(const Json& before, const std::string& list);
  /// What was added is printed when enough has come together.
  void add(const Json& element);
  /// `after` are the members behind the list, at least one. Prints what is left.
  void finish(const Json& after);

 private:
  void append(const Json& element);

  std::string text_;
  bool is_empty_ = true;
};

}  // namespace frontmost::cli
