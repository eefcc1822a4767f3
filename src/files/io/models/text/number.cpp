// SPDX-License-Identifier: Apache-2.0
// Rare spellings of a number, apart from the short ones that number.h reads inline: many digits, exponents, and all
// that C libraries ever printed for infinity and NaN.
#include "io/models/text/number.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

namespace frontmost::detail {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// If `word`, in any case, is at `at` and not part of a longer word, returns its end, else null.
const char* match(const char* at, const char* end, std::string_view word) {
  if (std::size_t(end - at) < word.size()) return nullptr;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((is_letter(at[i]) ? char(at[i] | 0x20) : at[i]) != word[i]) return nullptr;
  const char* after = at + word.size();
  return after != end && is_letter(*after) ? nullptr : after;
}

/// Skips what C libraries print behind "nan": "(ind)", "(snan)", "(0x7ff)".
const char* skip_payload(const char* at, const char* end) {
  if (at == end || *at != '(') return at;
  const char* p = at + 1;
  while (p != end && (is_letter(*p) || is_digit(*p) || *p == '_')) ++p;
  return p != end && *p == ')' ? p + 1 : at;
}

/// Reads nan, nan(payload), inf, infinity, and the spellings of old Microsoft libraries: 1.#QNAN, 1.#IND, 1.#INF.
template <class T>
const char* parse_special(const char* at, const char* end, T& magnitude) {
  constexpr T nan = std::numeric_limits<T>::quiet_NaN(), inf = std::numeric_limits<T>::infinity();
  constexpr struct {
    std::string_view word;
    T value;
  } words[] = {{"nan", nan},     {"inf", inf},    {"infinity", inf}, {"1.#qnan", nan},
               {"1.#snan", nan}, {"1.#ind", nan}, {"1.#inf", inf}};
  for (const auto& special : words)
    if (const char* after = match(at, end, special.word)) {
      magnitude = special.value;
      // "1.#IND00" is padded to the requested number of digits.
      while (special.word[0] == '1' && after != end && is_digit(*after)) ++after;
      return special.word == "nan" ? skip_payload(after, end) : after;
    }
  return nullptr;
}

/// The end of the decimal number at `at`; null if there is none. `is_small` tells that a number out of range is too
/// small.
const char* scan_decimal(const char* at, const char* end, bool& is_small) {
  const char* p = at;
  std::int64_t leading = 0, point = 0;
  bool any = false, seen_nonzero = false;
  for (; p != end && is_digit(*p); ++p, any = true) {
    seen_nonzero |= *p != '0';
    leading += seen_nonzero;
  }
  if (p != end && *p == '.')
    for (++p; p != end && is_digit(*p); ++p, any = true) {
      if (!seen_nonzero && *p == '0') --point;
      seen_nonzero |= *p != '0';
    }
  if (!any) return nullptr;
  std::int64_t exponent = 0;
  if (p != end && (*p == 'e' || *p == 'E')) {
    const char* q = p + 1;
    const bool negative = q != end && *q == '-';
    if (q != end && (*q == '-' || *q == '+')) ++q;
    if (q != end && is_digit(*q)) {
      for (; q != end && is_digit(*q); ++q)
        exponent = std::min<std::int64_t>(10 * exponent + (*q - '0'), 1'000'000'000);
      if (negative) exponent = -exponent;
      p = q;
    }
  }
  is_small = !seen_nonzero || (leading > 0 ? leading : point) + exponent < 0;
  return p;
}

/// The number nearest to the digits [at, end). \returns false if it is out of range.
template <class T>
bool nearest(const char* at, const char* end, T& value) {
#if defined(__cpp_lib_to_chars)
  return std::from_chars(at, end, value).ec == std::errc();
#else
  // Libraries without from_chars for floats (WebAssembly) have only the C locale.
  if constexpr (sizeof(T) == sizeof(float))
    value = std::strtof(std::string(at, end).c_str(), nullptr);
  else
    value = std::strtod(std::string(at, end).c_str(), nullptr);
  return true;
#endif
}

template <class T>
const char* parse_slowly(const char* at, const char* end, T& value) {
  const bool negative = at != end && *at == '-';
  if (at != end && (*at == '-' || *at == '+')) ++at;
  T magnitude = 0;
  const char* after = parse_special(at, end, magnitude);
  if (after == nullptr) {
    bool is_small = false;
    after = scan_decimal(at, end, is_small);
    if (after == nullptr) return nullptr;
    if (!nearest(at, after, magnitude)) magnitude = is_small ? T(0) : std::numeric_limits<T>::infinity();
  }
  value = negative ? -magnitude : magnitude;
  return after;
}

}  // namespace

const char* parse_float_slowly(const char* at, const char* end, float& value) { return parse_slowly(at, end, value); }

const char* parse_double_slowly(const char* at, const char* end, double& value) { return parse_slowly(at, end, value); }

}  // namespace frontmost::detail
