// SPDX-License-Identifier: Apache-2.0
// Decimal text of doubles, as std::to_chars() writes it, even if the standard library lacks std::to_chars() for doubles
// (WebAssembly). There, C's functions always write a decimal point, because there is only one locale.
#pragma once

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace frontmost {

#if defined(__cpp_lib_to_chars)
/// Text with significant digits: six digits of 1234567 are 1.23457e+06.
[[nodiscard]] inline std::string general_text(double value, int digits) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}
/// Text with decimals: one decimal gives 12.3.
[[nodiscard]] inline std::string fixed_text(double value, int decimals) {
  char text[400];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr};
}
/// The fewest digits that tell the number from all others.
[[nodiscard]] inline std::string shortest_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}
#else
[[nodiscard]] inline std::string general_text(double value, int digits) {
  char text[64];
  return {text, std::size_t(std::snprintf(text, sizeof text, "%.*g", digits, value))};
}
[[nodiscard]] inline std::string fixed_text(double value, int decimals) {
  char text[400];
  return {text, std::size_t(std::snprintf(text, sizeof text, "%.*f", decimals, value))};
}
[[nodiscard]] inline std::string shortest_text(double value) {
  for (int digits = 1; digits < 17; ++digits)
    if (std::string text = general_text(value, digits); std::strtod(text.c_str(), nullptr) == value) return text;
  return general_text(value, 17);
}
#endif

}  // namespace frontmost
