// SPDX-License-Identifier: Apache-2.0
// Text of drawings: numbers in fixed point, names made harmless, through a buffer to wherever bytes go.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>

#include "base/output_file.h"

namespace frontmost::detail {

/// Where text goes.
class ByteSink {
 public:
  ByteSink() = default;
  virtual ~ByteSink() = default;
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;
  virtual void write(std::string_view bytes) = 0;
};

class FileSink final : public ByteSink {
 public:
  explicit FileSink(OutputFile& file) : file_(file) {}
  void write(std::string_view bytes) override { file_.write(std::as_bytes(std::span(bytes.data(), bytes.size()))); }

 private:
  OutputFile& file_;
};

/// Thousandths, as coordinates are rounded: millimetres come in as doubles of at most 1e9, so that they fit.
[[nodiscard]] inline std::int64_t thousandths(double value) { return std::llround(value * 1000); }
[[nodiscard]] inline glm::i64vec2 thousandths(const glm::dvec2& p) { return {thousandths(p.x), thousandths(p.y)}; }

/// A buffer in front of a sink. Numbers by hand: nine nanoseconds each, to_chars takes eighty.
class PageText {
 public:
  explicit PageText(ByteSink& sink) : sink_(sink), buffer_(capacity, '\0') {}

  PageText& operator<<(std::string_view text);
  PageText& operator<<(char character) {
    if (used_ == capacity) pass_on();
    buffer_[used_++] = character;
    return *this;
  }
  /// Decimal, without a fraction.
  PageText& integer(std::int64_t value);
  /// value / 10^digits, without zeros at its end. `digits` from 1 to 9.
  PageText& fixed(std::int64_t value, int digits = 3);
  /// Rounded to `digits`, with the zero before the point that JSON and DXF want and the others do without.
  PageText& decimal(double value, int digits = 3);
  /// Bytes taken so far.
  [[nodiscard]] std::uint64_t size() const { return passed_on_ + used_; }
  /// Must be called at the end.
  void flush() { pass_on(); }

 private:
  static constexpr std::size_t capacity = std::size_t(1) << 16;
  void pass_on();

  ByteSink& sink_;
  std::string buffer_;
  std::size_t used_ = 0;
  std::uint64_t passed_on_ = 0;
};

/// Takes the first character of UTF-8 away; not empty. A byte that begins none is taken alone, as U+FFFD.
[[nodiscard]] char32_t take_character(std::string_view& text);

/// For element content and attributes of XML 1.0, as printable_text() writes what it does not allow.
[[nodiscard]] std::string xml_text(std::string_view name);
/// With its quotes, as utf8_text() writes it.
[[nodiscard]] std::string json_text(std::string_view name);
/// A PDF text string in UTF-16, as printable_text() writes it, as hexadecimal digits with their brackets.
[[nodiscard]] std::string pdf_text(std::string_view name);

}  // namespace frontmost::detail
