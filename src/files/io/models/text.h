// SPDX-License-Identifier: Apache-2.0
// Reads decimal numbers, and walks over a text file word by word and counts its lines.
//
//        v 1.5  -2  0  # left rim          word() takes "v", number() 1.5, and at_line_end() is true at the comment
//               ^ at_                      place() is "line 7", for messages
//
// All readers of text use these few steps. No step copies, allocates, or reads beyond the bytes: a mapped file has no
// zero at its end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "io/models/reader.h"

namespace frontmost {

// Numbers are rounded correctly to float or double, and read several times faster than by strtof on typical files.
//
//   "12.375" = 12375 / 1000
//
// Both numbers are doubles without rounding (15 digits, powers of ten up to 22), so the division rounds only once, and
// correctly. Nearly all numbers of all files have this form, and the loop is small enough to be inline. Others take a
// slow path.

namespace detail {
/// Reads numbers of the general form: many digits, large exponents, nan and inf in every spelling. Returns null if
/// there is no number.
const char* parse_float_slowly(const char* at, const char* end, float& value);
const char* parse_double_slowly(const char* at, const char* end, double& value);

inline constexpr double powers_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                           1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether a correctly rounded double can be rounded to the correct float. False if the double is half way between two
/// floats, because the digits that it lost would decide. False also where floats get sparser (subnormal) or end.
inline bool rounds_once(double magnitude) {
  std::uint64_t bits;
  std::memcpy(&bits, &magnitude, sizeof bits);
  constexpr std::uint64_t below_float = (std::uint64_t(1) << 29) - 1, half = std::uint64_t(1) << 28;
  return (bits & below_float) != half && magnitude >= 1e-37 && magnitude <= 1e38;
}

/// Reads [+-]digits[.digits] with at most 15 digits. \returns the first character after the number; null if there is no
/// number, or if it has more digits or goes on, for example with an exponent.
inline const char* parse_short(const char* at, const char* end, double& value) {
  const char* p = at;
  const bool negative = p != end && *p == '-';
  if (p != end && (*p == '-' || *p == '+')) ++p;
  const char* const digits = p;
  std::uint64_t whole = 0;
  for (; p != end && is_digit(*p); ++p) whole = 10 * whole + std::uint64_t(*p - '0');
  std::ptrdiff_t digit_count = p - digits;
  int exponent = 0;
  if (p != end && *p == '.') {
    const char* const fraction = ++p;
    for (; p != end && is_digit(*p); ++p) whole = 10 * whole + std::uint64_t(*p - '0');
    exponent = -int(p - fraction < 100 ? p - fraction : 100);
    digit_count += p - fraction;
  }
  const bool has_more = p != end && (*p == 'e' || *p == 'E' || *p == '#');
  if (digit_count == 0 || digit_count > 15 || has_more) return nullptr;
  const double magnitude = double(whole) / powers_of_ten[-exponent];
  value = negative ? -magnitude : magnitude;
  return p;
}

/// Rounds `exact`, the double nearest to a number, to the float nearest to that number. \returns false if that is
/// ambiguous.
inline bool round_to_float(double exact, float& value) {
  value = float(exact);
  return exact == 0 || rounds_once(exact < 0 ? -exact : exact);
}
}  // namespace detail

/// Reads [+-]digits[.digits][e[+-]digits], nan or inf at `at`. Beyond the range of float, the value is infinity or
/// zero.
/// \returns the first character after the number; null if there is none.
inline const char* parse_float(const char* at, const char* end, float& value) {
  double exact;
  const char* const after = detail::parse_short(at, end, exact);
  if (after == nullptr || !detail::round_to_float(exact, value)) return detail::parse_float_slowly(at, end, value);
  return after;
}

/// Reads a number as the nearest double. Otherwise like parse_float().
inline const char* parse_double(const char* at, const char* end, double& exact) {
  const char* const after = detail::parse_short(at, end, exact);
  return after != nullptr ? after : detail::parse_double_slowly(at, end, exact);
}

/// Reads a number as the nearest float and as the nearest double.
inline const char* parse_both(const char* at, const char* end, float& value, double& exact) {
  const char* const after = parse_double(at, end, exact);
  if (after == nullptr || detail::round_to_float(exact, value)) return after;
  return detail::parse_float_slowly(at, end, value);
}

/// Returns the value of a hexadecimal digit, or -1 for other characters.
inline int hex_digit(char c) {
  if (detail::is_digit(c)) return c - '0';
  const char lower = char(c | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// Reads [+-]digits. \returns the first character after it; null if there is none or it has over 18 digits.
inline const char* parse_integer(const char* at, const char* end, std::int64_t& value) {
  const char* p = at;
  const bool negative = p != end && *p == '-';
  if (p != end && (*p == '-' || *p == '+')) ++p;
  const char* const digits = p;
  std::uint64_t magnitude = 0;  // has room for a 19th digit, which is too many
  for (; p != end && detail::is_digit(*p) && p - digits < 19; ++p) magnitude = 10 * magnitude + std::uint64_t(*p - '0');
  if (p == digits || p - digits > 18) return nullptr;
  value = negative ? -std::int64_t(magnitude) : std::int64_t(magnitude);
  return p;
}

/// Reads a text word by word. Lines end with \n, \r\n or \r. If `comments` says so, a word that starts with '#' ends
/// its line. A backslash at the end of a line joins it with the next one.
class TextScanner {
 public:
  enum class Comments : bool { none, hash };

  TextScanner(Bytes bytes, const ModelSource& source, Comments comments = Comments::none)
      : at_(text_of(bytes).data()),
        end_(at_ + text_of(bytes).size()),
        released_(at_),
        source_(source),
        comments_(comments) {}

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] std::size_t bytes_left() const { return std::size_t(end_ - at_); }
  [[nodiscard]] const ModelSource& source() const { return source_; }
  [[nodiscard]] std::string place() const { return "line " + std::to_string(line_); }
  [[noreturn]] void fail(const std::string& reason) const { source_.fail(place(), reason); }

  /// Moves to the start of the next line. \returns false if there is none.
  bool next_line() {
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    if (at_ == end_) return false;
    end_line();
    return at_ != end_;
  }
  /// Whether nothing but blanks and comments follows on this line. Skips blanks.
  bool at_line_end() {
    skip_blanks();
    return at_ == end_ || *at_ == '\n' || *at_ == '\r' || (*at_ == '#' && comments_ == Comments::hash);
  }
  /// Moves to the next word, over line ends and comments. \returns false if there is none.
  bool to_word() {
    while (at_line_end())
      if (!next_line()) return false;
    return true;
  }

  /// Takes the next word of this line. \returns the word, which is empty at the end of the line.
  std::string_view word() {
    if (at_line_end()) return {};
    const char* const start = at_;
    while (at_ != end_ && !is_space(*at_)) ++at_;
    return {start, std::size_t(at_ - start)};
  }
  /// Takes the rest of the line, with comments. \returns the rest without blanks around it.
  std::string_view rest() {
    skip_blanks();
    const char* const start = at_;
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    const char* last = at_;
    while (last != start && is_space(last[-1])) --last;
    return {start, std::size_t(last - start)};
  }
  /// Reads the next word of this line as a number. \returns false, without moving, if it is none.
  bool number(float& value) {
    skip_blanks();
    return move_to(parse_float(at_, end_, value));
  }
  /// Reads a number as float and as double.
  bool number(float& value, double& exact) {
    skip_blanks();
    return move_to(parse_both(at_, end_, value, exact));
  }
  bool integer(std::int64_t& value) {
    skip_blanks();
    return move_to(parse_integer(at_, end_, value));
  }
  /// Reads an integer without skipping blanks.
  bool integer_here(std::int64_t& value) { return move_to(parse_integer(at_, end_, value)); }
  /// Consumes the next character if it is `c`, without skipping blanks.
  bool take(char c) {
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }
  /// Whether the next word of this line starts with `c`. Skips blanks.
  bool next_is(char c) { return !at_line_end() && *at_ == c; }
  /// Whether a word ends at this place.
  [[nodiscard]] bool at_blank() const { return at_ == end_ || is_space(*at_); }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

  void skip_blanks() {
    for (; at_ != end_; ++at_) {
      if (*at_ == ' ' || *at_ == '\t' || *at_ == '\f' || *at_ == '\v') continue;
      if (*at_ != '\\' || !join_lines()) return;
    }
  }
  bool move_to(const char* after) {
    if (after == nullptr) return false;
    at_ = after;
    return true;
  }
  /// Skips a line end. Precondition: the scanner is at one.
  void end_line() {
    if (*at_ == '\r' && end_ - at_ > 1 && at_[1] == '\n') ++at_;
    ++at_;
    ++line_;
    if (at_ - released_ > release_step) release();
  }
  /// Moves to the last character of the line end that follows a backslash. Precondition: the scanner is at the
  /// backslash.
  bool join_lines();
  void release();

  static constexpr std::ptrdiff_t release_step = 1 << 20;
  const char* at_;
  const char* end_;
  const char* released_;
  std::size_t line_ = 1;
  const ModelSource& source_;
  Comments comments_;
};

}  // namespace frontmost
