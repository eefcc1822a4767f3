// SPDX-License-Identifier: Apache-2.0
// The page's questions and answers as JSON: vectors, matrices, and addresses of data that is too long for text.
#pragma once

#include <frontmost/base.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace frontmost::web {

/// JSON with sorted keys, the type that the library's parser uses, so that the module contains only one.
using PlainJson = nlohmann::json;

template <int n, class T>
[[nodiscard]] PlainJson to_json(const glm::vec<n, T>& vector) {
  PlainJson result = PlainJson::array();
  for (int i = 0; i < n; ++i) result.push_back(vector[i]);
  return result;
}
/// Four rows of four.
[[nodiscard]] inline PlainJson to_json(const glm::dmat4& matrix) {
  PlainJson rows = PlainJson::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back(
        PlainJson::array({matrix[0][row] + 0.0, matrix[1][row] + 0.0, matrix[2][row] + 0.0, matrix[3][row] + 0.0}));
  return rows;
}
[[nodiscard]] inline glm::dvec3 vector_of(const PlainJson& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}
/// The value, or null if it is infinite, since JSON has no infinity.
[[nodiscard]] inline PlainJson finite_or_null(double value) {
  return std::isfinite(value) ? PlainJson(value) : PlainJson(nullptr);
}

/// The address and size of values in the module's memory, valid until the next question.
template <class T>
[[nodiscard]] PlainJson place_of(const T* values, std::size_t count) {
  return {{"at", std::uintptr_t(values)}, {"bytes", count * sizeof(T)}};
}

}  // namespace frontmost::web
