// SPDX-License-Identifier: Apache-2.0
// Checks the numbers and texts that the documentation states: "EXPRESSION;  // -> 1.5, 2" becomes
// expect(EXPRESSION, "1.5, 2").
#pragma once

#include <frontmost/frontmost.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace frontmost::test {

inline int failure_count = 0;

inline std::vector<double> numbers(double value) { return {value}; }
template <int size, class T>
std::vector<double> numbers(const glm::vec<size, T>& vector) {
  std::vector<double> result;
  for (int i = 0; i < size; ++i) result.push_back(double(vector[i]));
  return result;
}

/// A number of a text, with half a unit of its last digit as tolerance.
struct Written {
  double value, tolerance;
};
inline std::vector<Written> parse(const std::string& text) {
  std::vector<Written> result;
  const char* rest = text.c_str();
  for (;;) {
    while (*rest == ' ' || *rest == ',' || *rest == '(') ++rest;
    char* end = nullptr;
    const double value = std::strtod(rest, &end);
    if (end == rest) return result;
    const std::string digits(rest, std::size_t(end - rest));
    const std::size_t point = digits.find('.');
    const int decimals = point == std::string::npos ? 0 : int(digits.size() - point - 1);
    // Whole numbers are exact but for rounding in the computation.
    result.push_back({value, decimals ? 0.5001 * std::pow(10.0, -decimals) : 1e-6});
    rest = end;
  }
}

template <class T>
void expect(const T& value, const char* text, const char* page, int line) {
  const std::vector<double> found = numbers(value);
  const std::vector<Written> written = parse(text);
  bool equal = found.size() == written.size();
  for (std::size_t i = 0; equal && i < found.size(); ++i) {
    equal = found[i] == written[i].value || std::abs(found[i] - written[i].value) <= written[i].tolerance;
  }
  if (equal) return;
  ++failure_count;
  std::printf("%s:%d: the page says %s, the library", page, line, text);
  for (const double number : found) std::printf(" %.9g", number);
  std::printf("\n");
}
inline void expect(const std::string& value, const char* text, const char* page, int line) {
  if (value == text) return;
  ++failure_count;
  std::printf("%s:%d: the page says %s, the library %s\n", page, line, text, value.c_str());
}

}  // namespace frontmost::test

using frontmost::test::expect;
