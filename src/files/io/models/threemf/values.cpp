// SPDX-License-Identifier: Apache-2.0
// Numbers of attributes, read as strictly as the schema defines except for blanks. A value with anything behind it is
// refused, because half of a transform would place an object somewhere.
#include <algorithm>
#include <cmath>

#include "frontmost/base.h"
#include "io/models/mesh_building.h"
#include "io/models/text/number.h"
#include "io/models/threemf/xml_part.h"

namespace frontmost::threemf {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// The value of a hexadecimal digit; 16 for other characters.
int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char lower = char(c | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : 16;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const std::string_view word = trimmed(text);
  double value = 0;
  const char* const end = word.data() + word.size();
  return parse_double(word.data(), end, value) == end ? std::optional(value) : std::nullopt;
}

std::optional<std::uint32_t> parse_index(std::string_view text) {
  const std::string_view word = trimmed(text);
  std::int64_t value = 0;
  const char* const end = word.data() + word.size();
  if (parse_integer(word.data(), end, value) != end || value < 0 || value >= std::int64_t(no_index))
    return std::nullopt;
  return std::uint32_t(value);
}

std::optional<glm::vec4> parse_color(std::string_view text) {
  const std::string_view word = trimmed(text);
  if ((word.size() != 7 && word.size() != 9) || word[0] != '#') return std::nullopt;
  glm::vec4 srgb(1);
  for (std::size_t k = 0; 2 * k + 1 < word.size(); ++k) {
    const int high = digit(word[2 * k + 1]), low = digit(word[2 * k + 2]);
    if (high > 15 || low > 15) return std::nullopt;
    srgb[int(k)] = float(16 * high + low) / 255.0f;
  }
  return linear_color(srgb);
}

std::optional<glm::dmat4> parse_transform(std::string_view text) {
  glm::dmat4 matrix(1.0);
  for (int i = 0; i < 12; ++i) {
    text = trimmed(text);
    const std::size_t size = std::min(text.find_first_of(blanks), text.size());
    const std::optional<double> value = parse_number(text.substr(0, size));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    matrix[i / 3][i % 3] = *value;
    text.remove_prefix(size);
  }
  return trimmed(text).empty() ? std::optional(matrix) : std::nullopt;
}

}  // namespace frontmost::threemf
