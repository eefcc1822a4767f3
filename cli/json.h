// SPDX-License-Identifier: Apache-2.0
// JSON as reports print it: vectors and matrices, the text of all of it, and long lists that are printed while they are
// made.
#pragma once

#include <frontmost/base.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace frontmost::cli {

/// Keys stay in the order in which they were set, which is the order to read them in.
using Json = nlohmann::ordered_json;

template <int n, class T>
[[nodiscard]] Json to_json(const glm::vec<n, T>& vector) {
  Json result = Json::array();
  for (int i = 0; i < n; ++i) result.push_back(vector[i]);
  return result;
}

/// Four rows of four, as matrices are written on paper.
[[nodiscard]] inline Json to_json(const glm::dmat4& matrix) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) {
    // Adding 0 turns -0 into 0, which reads better and means the same.
    rows.push_back(
        Json::array({matrix[0][row] + 0.0, matrix[1][row] + 0.0, matrix[2][row] + 0.0, matrix[3][row] + 0.0}));
  }
  return rows;
}

/// JSON has no infinity; an infinite far plane is null.
[[nodiscard]] inline Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// The least, the median and the greatest of the times that something took. Precondition: not empty.
[[nodiscard]] Json times_json(const std::vector<double>& times);

/// \returns the text with a line break at the end. Texts are as utf8_text() writes them.
[[nodiscard]] std::string dump(const Json& json);

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
