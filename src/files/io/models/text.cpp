// SPDX-License-Identifier: Apache-2.0
// The rare steps of reading text, kept out of line so that the loops over words stay short. The library fast_float
// reads numbers with many digits or an exponent, which text.h does not read inline. All spellings of infinity and NaN
// that C libraries print are known.
//
// D. Lemire. Number Parsing at a Gigabyte per Second. 2021.
#include "io/models/text.h"

#include <fast_float/fast_float.h>

#include <limits>
#include <string_view>
#include <system_error>

#include "base/parallel.h"

namespace frontmost::detail {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Returns the end of `word`, in any case, if it is at `at` and not part of a longer word; otherwise null.
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

template <class T>
const char* parse_slowly(const char* at, const char* end, T& value) {
  const bool negative = at != end && *at == '-';
  if (at != end && (*at == '-' || *at == '+')) ++at;
  T magnitude = 0;
  const char* after = nullptr;
  // fast_float would accept a second sign, and other spellings of nan and inf.
  if (at != end && (is_digit(*at) || *at == '.')) {
    const auto [last, error] = fast_float::from_chars(at, end, magnitude);
    if (error == std::errc::invalid_argument) return nullptr;
    after = last;  // beyond the range, the value is infinity or zero
  }
  if (after == nullptr || (after != end && *after == '#'))
    if (const char* const special = parse_special(at, end, magnitude)) after = special;
  if (after == nullptr) return nullptr;
  value = negative ? -magnitude : magnitude;
  return after;
}

}  // namespace

const char* parse_float_slowly(const char* at, const char* end, float& value) { return parse_slowly(at, end, value); }

const char* parse_double_slowly(const char* at, const char* end, double& value) { return parse_slowly(at, end, value); }

}  // namespace frontmost::detail

namespace frontmost {

bool TextScanner::join_lines() {
  const char* p = at_ + 1;
  if (p != end_ && *p == '\r' && end_ - p > 1 && p[1] == '\n') ++p;
  if (p == end_ || (*p != '\n' && *p != '\r')) return false;
  at_ = p;
  ++line_;
  return true;
}

void TextScanner::release() {
  source_.release({reinterpret_cast<const std::byte*>(released_), std::size_t(at_ - released_)});
  released_ = at_;
  check_cancelled(source_.execution());
}

}  // namespace frontmost
