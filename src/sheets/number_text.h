// SPDX-License-Identifier: Apache-2.0
// Numbers as scales, names of papers and complaints have them, whatever the locale.
#pragma once

#include <charconv>
#include <glm/glm.hpp>
#include <string>

namespace frontmost::detail {

/// Of so many digits that count, without zeros behind the point at its end: "0.25", "1e+07".
[[nodiscard]] inline std::string number_text(double value, int digits = 6) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}

/// Two sides: "210 x 297".
[[nodiscard]] inline std::string size_text(const glm::dvec2& size, int digits = 6) {
  return number_text(size.x, digits) + " x " + number_text(size.y, digits);
}

/// Two sides in millimetres to a tenth: "12.0 x 7.5".
[[nodiscard]] inline std::string tenths_text(const glm::dvec2& size) {
  char text[800];
  char* end = std::to_chars(text, text + 390, size.x, std::chars_format::fixed, 1).ptr;
  for (const char c : {' ', 'x', ' '}) *end++ = c;
  return {text, std::to_chars(end, text + sizeof text, size.y, std::chars_format::fixed, 1).ptr};
}

}  // namespace frontmost::detail
