// SPDX-License-Identifier: Apache-2.0
// Converts text to values, for flags and batch files alike. All of the text must be valid, finite and in range, in any
// locale.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frontmost::cli {

inline constexpr double radians_per_degree = 0.017453292519943295, degrees_per_radian = 57.29577951308232;

/// Inclusive limits of a number.
struct NumberLimits {
  double low, high;
};
inline constexpr NumberLimits any_number{-1e30, 1e30};

/// All functions below throw UsageError, which says what is wrong and what would be right. The caller prepends the
/// flag's name.
[[nodiscard]] double parse_number(std::string_view text, const NumberLimits& range = any_number);
[[nodiscard]] int parse_integer(std::string_view text, const NumberLimits& range);
/// Returns exactly `count` numbers, or between `count` and `most`, separated by commas.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text, std::size_t count,
                                                const NumberLimits& range = any_number);
[[nodiscard]] glm::dvec3 parse_vector(std::string_view text);
/// Returns a vector, or an axis such as "x", "+Z" or "-y". The result is not zero.
[[nodiscard]] glm::dvec3 parse_direction(std::string_view text);
/// Returns the index of `text` among `choices`, which are separated by '|'.
[[nodiscard]] int parse_choice(std::string_view text, std::string_view choices);
/// Returns a colour as sRGB 0 to 1: "#rgb", "#rrggbb", "r,g,b" from 0 to 1, or one of a few names.
[[nodiscard]] glm::vec3 parse_color(std::string_view text);
/// Returns a matrix of 16 numbers (or 12: the last row is 0 0 0 1), row by row, separated by commas, blanks, brackets
/// and semicolons. Returns nothing if the text holds no numbers.
[[nodiscard]] std::optional<glm::dmat4> parse_matrix(std::string_view text);
/// Parts of parse_matrix(). The first one removes the next number from the text and returns it, or returns an empty
/// text at the end. The second one makes the matrix.
[[nodiscard]] std::string_view take_matrix_word(std::string_view& text);
[[nodiscard]] glm::dmat4 matrix_of(std::vector<double> values);
/// Return text for error messages: shortened() cuts long text, and quoted() also adds quotes.
[[nodiscard]] std::string shortened(std::string_view text);
[[nodiscard]] std::string quoted(std::string_view text);

/// Returns the candidate nearest to a mistyped word, or an empty text if none is near enough.
[[nodiscard]] std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace frontmost::cli
