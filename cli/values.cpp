// SPDX-License-Identifier: Apache-2.0
// Converts text to values by std::from_chars, whatever the locale. Trailing text and hexadecimal numbers are errors.
#include "cli/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "cli/failure.h"

namespace frontmost::cli {
namespace {

// Returns the text without a leading '+', which from_chars refuses, but users write: "+1,0,0".
std::string_view without_plus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

/// Returns a number that from_chars() refuses because it rounds to infinity or to zero. Precondition: the whole text is
/// a number.
double beyond_doubles(std::string_view text) { return std::strtod(std::string(text).c_str(), nullptr); }

std::optional<double> to_double(std::string_view text) {
  text = without_plus(text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) return beyond_doubles(text);
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }

std::optional<glm::dvec3> axis(std::string_view text) {
  double sign = 1;
  if (!text.empty() && (text[0] == '+' || text[0] == '-')) {
    sign = text[0] == '-' ? -1 : 1;
    text.remove_prefix(1);
  }
  if (text.size() != 1) return std::nullopt;
  const char letter = lower(text[0]);
  if (letter < 'x' || letter > 'z') return std::nullopt;
  glm::dvec3 result(0.0);
  result[letter - 'x'] = sign;
  return result;
}

std::optional<glm::vec3> hex_color(std::string_view text) {
  if (text.empty() || text[0] != '#' || (text.size() != 4 && text.size() != 7)) return std::nullopt;
  const std::size_t digits = text.size() == 4 ? 1 : 2;
  glm::vec3 color;
  for (std::size_t i = 0; i < 3; ++i) {
    unsigned value = 0;
    const char* const first = text.data() + 1 + i * digits;
    const auto [end, error] = std::from_chars(first, first + digits, value, 16);
    if (error != std::errc() || end != first + digits) return std::nullopt;
    color[int(i)] = float(value) / (digits == 1 ? 15.0f : 255.0f);
  }
  return color;
}

/// Returns the number of insertions, deletions, replacements and swaps of neighbours that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, row(b.size() + 1), above;
  std::iota(row.begin(), row.end(), 0u);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = above;
    above = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

double parse_number(std::string_view text, const NumberLimits& range) {
  const std::optional<double> value = to_double(trimmed(text));
  if (!value) throw UsageError(fmt::format("{} is not a number", quoted(text)));
  // The comparison fails for NaN.
  if (!(*value >= range.low && *value <= range.high)) {
    const std::string shown = shortened(text);
    if (range.low == any_number.low) throw UsageError(fmt::format("{} is not a usable number", shown));
    if (range.high == any_number.high) throw UsageError(fmt::format("{} is below {}", shown, range.low));
    throw UsageError(fmt::format("{} is not between {} and {}", shown, range.low, range.high));
  }
  return *value;
}

int parse_integer(std::string_view text, const NumberLimits& range) {
  const double value = parse_number(text, range);
  if (value != std::floor(value)) throw UsageError(fmt::format("{} is not a whole number", shortened(text)));
  return int(value);
}

std::vector<double> parse_numbers(std::string_view text, std::size_t count, const NumberLimits& range) {
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != count) {
    throw UsageError(
        fmt::format("{} has {} values, {} are needed, separated by commas", quoted(text), parts.size(), count));
  }
  std::vector<double> values;
  for (const std::string_view part : parts) values.push_back(parse_number(part, range));
  return values;
}

glm::dvec3 parse_vector(std::string_view text) {
  const std::vector<double> values = parse_numbers(text, 3);
  return {values[0], values[1], values[2]};
}

glm::dvec3 parse_direction(std::string_view text) {
  if (const std::optional<glm::dvec3> named = axis(trimmed(text))) return *named;
  const glm::dvec3 vector = parse_vector(text);
  if (glm::length(vector) < 1e-30) throw UsageError(fmt::format("{} has no direction", quoted(text)));
  return vector;
}

int parse_choice(std::string_view text, std::string_view choices) {
  const std::vector<std::string_view> words = split(choices, '|');
  // Case is ignored, because some words are capitals elsewhere (LESS, D24).
  const auto same = [&](std::string_view word) {
    return std::equal(word.begin(), word.end(), text.begin(), text.end(),
                      [](char a, char b) { return lower(a) == lower(b); });
  };
  const auto found = std::find_if(words.begin(), words.end(), same);
  if (found != words.end()) return int(found - words.begin());
  throw UsageError(fmt::format("{} is not one of {}", quoted(text), fmt::join(words, ", ")));
}

glm::vec3 parse_color(std::string_view text) {
  struct Named {
    std::string_view name;
    glm::vec3 color;
  };
  static constexpr Named names[] = {{"white", {1, 1, 1}},         {"black", {0, 0, 0}}, {"gray", {0.5f, 0.5f, 0.5f}},
                                    {"grey", {0.5f, 0.5f, 0.5f}}, {"red", {1, 0, 0}},   {"green", {0, 0.5f, 0}},
                                    {"blue", {0, 0, 1}}};
  for (const Named& entry : names) {
    if (entry.name == text) return entry.color;
  }
  if (const std::optional<glm::vec3> color = hex_color(text)) return *color;
  if (text.find(',') == std::string_view::npos) {
    throw UsageError(
        fmt::format("{} is not a colour: #rrggbb, r,g,b from 0 to 1, or white, black, gray, red, green, "
                    "blue, transparent",
                    quoted(text)));
  }
  const std::vector<double> values = parse_numbers(text, 3, {0, 1});
  return glm::vec3(float(values[0]), float(values[1]), float(values[2]));
}

std::optional<glm::dmat4> parse_matrix(std::string_view text) {
  std::vector<double> values;
  for (std::string_view word = take_matrix_word(text); !word.empty(); word = take_matrix_word(text)) {
    const std::optional<double> value = to_double(word);
    if (!value) return std::nullopt;
    if (!std::isfinite(*value)) throw UsageError("a matrix entry is not finite");
    values.push_back(*value);
    if (values.size() > 16) throw UsageError("more than 16 numbers");
  }
  return matrix_of(std::move(values));
}

std::string_view take_matrix_word(std::string_view& text) {
  constexpr std::string_view separators = " \t\r\n,;[]()";
  text.remove_prefix(std::min(text.find_first_not_of(separators), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(separators));
  text.remove_prefix(word.size());
  return word;
}

glm::dmat4 matrix_of(std::vector<double> values) {
  if (values.size() == 12) values.insert(values.end(), {0, 0, 0, 1});
  if (values.size() != 16) throw UsageError(fmt::format("{} numbers; a pose is 16 (or 12), row by row", values.size()));
  glm::dmat4 matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix[column][row] = values[std::size_t(row * 4 + column)];
  }
  return matrix;
}

std::string shortened(std::string_view text) {
  constexpr std::size_t longest = 80;
  return fmt::format("{}{}", text.substr(0, longest), text.size() > longest ? "..." : "");
}

std::string quoted(std::string_view text) { return "'" + shortened(text) + "'"; }

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates) {
  constexpr std::size_t longest = 64;
  if (word.size() > longest) return {};  // no choice is that long, and the time is the product of both lengths
  std::string_view best;
  // A third of the letters may be wrong; beyond that, another word is meant.
  std::size_t best_distance = std::max<std::size_t>(word.size() / 3, 1) + 1;
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance >= best_distance) continue;
    best_distance = distance;
    best = candidate;
  }
  return best;
}

}  // namespace frontmost::cli
