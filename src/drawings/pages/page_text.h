// SPDX-License-Identifier: Apache-2.0
// Text of drawings: numbers in fixed point and escaped names, through a buffer to a sink of bytes.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>

#include "base/output_file.h"

namespace frontmost::detail {

/// A destination of bytes.
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

/// Coordinates are rounded to thousandths. Millimetres are doubles of at most 1e9, so the result fits.
[[nodiscard]] inline std::int64_t thousandths(double value) { return std::llround(value * 1000); }
[[nodiscard]] inline glm::i64vec2 thousandths(const glm::dvec2& p) { return {thousandths(p.x), thousandths(p.y)}; }

/// A buffer in front of a sink. Its own number formatting takes nine nanoseconds per number; to_chars takes eighty.
class PageText {
 public:
  explicit PageText(ByteSink& sink) : sink_(sink), buffer_(capacity, '\0') {}

  PageText& operator<<(std::string_view text);
  PageText& operator<<(char character) {
    if (used_ == capacity) pass_on();
    buffer_[used_++] = character;
    return *this;
  }
  /// Writes a decimal number without a fraction.
  PageText& integer(std::int64_t value);
  /// Writes value / 10^digits without trailing zeros. `digits` is 1 to 9.
  PageText& fixed(std::int64_t value, int digits = 3);
  /// Writes a number rounded to `digits`, with the zero before the point, which JSON and DXF need and other formats do
  /// not.
  PageText& decimal(double value, int digits = 3);
  /// Number of bytes written so far.
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

/// Removes and returns the first character of UTF-8 text that is not empty. An invalid byte is removed alone, as
/// U+FFFD.
[[nodiscard]] char32_t take_character(std::string_view& text);

/// A name for element content and attributes of XML 1.0; printable_text() replaces characters that XML forbids.
[[nodiscard]] std::string xml_text(std::string_view name);
/// A JSON string with quotes, encoded by utf8_text().
[[nodiscard]] std::string json_text(std::string_view name);
/// A PDF text string in UTF-16, cleaned by printable_text(), as hexadecimal digits in brackets.
[[nodiscard]] std::string pdf_text(std::string_view name);

}  // namespace frontmost::detail
