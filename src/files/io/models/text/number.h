// SPDX-License-Identifier: Apache-2.0
// Reads decimal numbers from text, correctly rounded to float or double, several times faster than strtof on typical
// files.
//
//   "12.375" = 12375 / 1000
//
// Both numbers are doubles without rounding (15 digits, powers of ten up to 22), so the division rounds only once, and
// correctly. Nearly all numbers of all files have this form, and the loop is small enough to be inline. Others take a
// slow path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace frontmost {

namespace detail {
/// The general case: many digits, large exponents, nan and inf in every spelling. Returns null if there is no number.
const char* parse_float_slowly(const char* at, const char* end, float& value);
const char* parse_double_slowly(const char* at, const char* end, double& value);

inline constexpr double powers_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                           1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether rounding a correctly rounded double to float is correct. False if the double is half way between two floats,
/// because digits that it lost would decide, and where floats get sparser (subnormal) or end.
inline bool rounds_once(double magnitude) {
  std::uint64_t bits;
  std::memcpy(&bits, &magnitude, sizeof bits);
  constexpr std::uint64_t below_float = (std::uint64_t(1) << 29) - 1, half = std::uint64_t(1) << 28;
  return (bits & below_float) != half && magnitude >= 1e-37 && magnitude <= 1e38;
}
}  // namespace detail

namespace detail {
/// Reads [+-]digits[.digits] with at most 15 digits. \returns the first character after the number; null if there is no
/// number, or if it is longer or goes on.
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
  // 15 digits are below 2^53, and powers of ten up to 22 are exact, so the division rounds only once.
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

/// Reads a number as the nearest double; otherwise like parse_float().
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

}  // namespace frontmost
