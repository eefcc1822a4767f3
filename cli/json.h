// SPDX-License-Identifier: Apache-2.0
// JSON for reports: vectors and matrices, dump(), and long lists that are printed while they are made.
#pragma once

#include <frontmost/base.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace frontmost::cli {

/// JSON whose keys keep the order in which they were set.
using Json = nlohmann::ordered_json;

template <int n, class T>
[[nodiscard]] Json to_json(const glm::vec<n, T>& vector) {
  Json result = Json::array();
  for (int i = 0; i < n; ++i) result.push_back(vector[i]);
  return result;
}

/// Returns a matrix as four rows of four numbers, as on paper.
[[nodiscard]] inline Json to_json(const glm::dmat4& matrix) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) {
    // Adding 0 turns -0 into 0, which reads better and means the same.
    rows.push_back(
        Json::array({matrix[0][row] + 0.0, matrix[1][row] + 0.0, matrix[2][row] + 0.0, matrix[3][row] + 0.0}));
  }
  return rows;
}

/// Returns the value, or null if it is infinite (as a far plane may be), because JSON has no infinity.
[[nodiscard]] inline Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Returns the least, median and greatest of several times. Precondition: not empty.
[[nodiscard]] Json times_json(const std::vector<double>& times);

/// Returns the text with a line break at its end. Strings are converted by utf8_text().
[[nodiscard]] std::string dump(const Json& json);

/// Prints an object with a long list, one element at a time. The text equals dump() of the whole, which is never in
/// memory.
class JsonListPrinter {
 public:
  /// Begins an object. `before` holds the members before the list, at least one.
  JsonListPrinter(const Json& before, const std::string& list);
  /// Adds an element. The text is printed in large pieces.
  void add(const Json& element);
  /// Ends the object and prints the rest. `after` holds the members behind the list, at least one.
  void finish(const Json& after);

 private:
  void append(const Json& element);

  std::string text_;
  bool is_empty_ = true;
};

}  // namespace frontmost::cli
