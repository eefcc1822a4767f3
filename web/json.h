// SPDX-License-Identifier: Apache-2.0
// Questions and answers of the page as JSON: vectors, matrices, and places in memory for what is too long for text.
#pragma once

#include <frontmost/base.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace frontmost::web {

using Json = nlohmann::ordered_json;

template <int n, class T>
[[nodiscard]] Json to_json(const glm::vec<n, T>& vector) {
  Json result = Json::array();
  for (int i = 0; i < n; ++i) result.push_back(vector[i]);
  return result;
}
/// Four rows of four.
[[nodiscard]] inline Json to_json(const glm::dmat4& matrix) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back(
        Json::array({matrix[0][row] + 0.0, matrix[1][row] + 0.0, matrix[2][row] + 0.0, matrix[3][row] + 0.0}));
  return rows;
}
[[nodiscard]] inline glm::dvec3 vector_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}
/// JSON has no infinity.
[[nodiscard]] inline Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Where `count` values lie in the module's memory until the next question.
template <class T>
[[nodiscard]] Json place_of(const T* values, std::size_t count) {
  return {{"at", std::uintptr_t(values)}, {"bytes", count * sizeof(T)}};
}

}  // namespace frontmost::web
