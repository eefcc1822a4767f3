// SPDX-License-Identifier: Apache-2.0
// The formats behind save(page), and their common parts: text, arcs and the appearance of paths.
//
//              . - .          A writer is a class over one page that appends text to a PageText.
//          .-'   |   '-.      The bulge of a join is the height of its arc by half of the chord:
//        from ---+--- to      the tangent of a quarter of its angle.
#pragma once

#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/output_file.h"
#include "base/parallel.h"
#include "frontmost/sheets.h"

namespace frontmost::detail {

/// Angles in radians from +x towards +y; `turn` is negative in the opposite direction.
struct Arc {
  glm::dvec2 centre{0};
  double radius = 0, begin = 0, turn = 0;
};

/// The arc from `from` to `to`. None within a ten-thousandth of a millimetre of its chord.
[[nodiscard]] std::optional<Arc> arc_between(const glm::dvec2& from, const glm::dvec2& to, double bulge);

/// The join that begins at point `i` of a path: its ends, and its bulge.
struct Join {
  glm::dvec2 from, to;
  double bulge;
};
[[nodiscard]] inline Join join_of(const PageGroup& group, const PagePath& path, std::uint32_t i) {
  const std::uint32_t at = path.first + i, next = i + 1 < path.count ? at + 1 : path.first;
  return {group.points[at], group.points[next], group.bulges.empty() ? 0 : group.bulges[at]};
}
[[nodiscard]] inline std::uint32_t join_count(const PagePath& path) {
  return path.is_closed ? path.count : path.count - 1;
}

/// The arc that a whole path forms, if all its joins run along one circle in one direction; none otherwise.
[[nodiscard]] std::optional<Arc> whole_arc(const PageGroup& group, const PagePath& path);

/// Where the point of a text lies between the lower edge of capitals, 0, and their upper edge, 1.
[[nodiscard]] inline double share_below(TextLine line) {
  return line == TextLine::bottom ? 0 : line == TextLine::middle ? 0.5 : 1;
}
/// The point of a text on its base line, at its beginning, its middle or its end by its alignment.
[[nodiscard]] inline glm::dvec2 base_of(const PlacedText& text) {
  return text.at + share_below(text.style.line) * text.style.height *
                       glm::dvec2(std::sin(text.style.angle), std::cos(text.style.angle));
}

/// Where the point of a text lies between the text's beginning, 0, and its end, 1.
[[nodiscard]] inline double share_before(TextAlign align) {
  return align == TextAlign::left ? 0 : align == TextAlign::centre ? 0.5 : 1;
}
/// The beginning of a text on its base line.
[[nodiscard]] inline glm::dvec2 begin_of(const PlacedText& text) {
  const double before = share_before(text.style.align) * text_width(text.text, text.style.height);
  return base_of(text) - before * glm::dvec2(std::cos(text.style.angle), -std::sin(text.style.angle));
}

/// Rounds a coordinate in millimetres to thousandths. Coordinates are at most 1e9, so the result fits.
[[nodiscard]] inline std::int64_t thousandths(double value) { return std::llround(value * 1000); }
[[nodiscard]] inline glm::i64vec2 thousandths(const glm::dvec2& p) { return {thousandths(p.x), thousandths(p.y)}; }

/// A buffer in front of a file, or of another sink of bytes. A number takes nine nanoseconds, by to_chars eighty.
class PageText {
 public:
  using Sink = std::function<void(std::string_view)>;
  explicit PageText(Sink sink) : sink_(std::move(sink)), buffer_(capacity, '\0') {}
  explicit PageText(OutputFile& file)
      : PageText(
            [&file](std::string_view bytes) { file.write(std::as_bytes(std::span(bytes.data(), bytes.size()))); }) {}

  PageText& operator<<(std::string_view text);
  PageText& operator<<(char character) {
    if (used_ == capacity) pass_on();
    buffer_[used_++] = character;
    return *this;
  }
  template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
  PageText& operator<<(Integer value) {
    return fixed(std::int64_t(value), 0);
  }
  /// Writes value / 10^digits without trailing zeros. `digits` is 0 to 9.
  PageText& fixed(std::int64_t value, int digits = 3);
  /// Writes a number rounded to `digits`, with the zero before the point, which only JSON and DXF need.
  PageText& decimal(double value, int digits = 3);
  /// Number of bytes written so far.
  [[nodiscard]] std::uint64_t size() const { return passed_on_ + used_; }
  /// Must be called at the end.
  void flush() { pass_on(); }

 private:
  static constexpr std::size_t capacity = std::size_t(1) << 16;
  void pass_on();

  Sink sink_;
  std::string buffer_;
  std::size_t used_ = 0;
  std::uint64_t passed_on_ = 0;
};

/// Removes and returns the first character of UTF-8 text that is not empty; an invalid byte alone, as U+FFFD.
[[nodiscard]] char32_t take_character(std::string_view& text);

/// A name for element content and attributes of XML 1.0; printable_text() replaces characters that XML forbids.
[[nodiscard]] std::string xml_text(std::string_view name);
/// A JSON string with quotes, encoded by utf8_text().
[[nodiscard]] std::string json_text(std::string_view name);
/// A PDF text string in UTF-16, cleaned by printable_text(), as hexadecimal digits in brackets.
[[nodiscard]] std::string pdf_text(std::string_view name);

/// Appends the last hexadecimal digits of a number.
void append_hex(unsigned value, std::string& text, int digits = 4);

/// The writers of the formats. They get valid pages, and do not commit the file.
void save_svg(const Page& page, OutputFile& file, const Execution& execution);
void save_pdf(std::span<const Page> pages, OutputFile& file, const Execution& execution);
/// \throws Error unsupported if some path is filled, before anything is written.
void save_dxf(const Page& page, OutputFile& file, const Execution& execution);
void save_json(const Page& page, OutputFile& file, const Execution& execution);

/// Reports the progress of writing, path by path and text by text.
class WritingProgress {
 public:
  WritingProgress(std::span<const Page> pages, const Execution& execution) : execution_(execution) {
    for (const Page& page : pages)
      for (const PageLayer& layer : page.layers)
        for (const PageGroup& group : layer.groups) count_ += group.paths.size() + group.texts.size();
    report_progress(execution, "write", 0);
  }
  /// Counts one path or text. \throws Error cancelled.
  void step() {
    if (++done_ % steps_between != 0) return;
    check_cancelled(execution_);
    report_progress(execution_, "write", double(done_) / double(count_));
  }

 private:
  static constexpr std::size_t steps_between = 4096;
  const Execution& execution_;
  std::size_t done_ = 0, count_ = 0;
};

/// The appearance of a path with its group's pen: the colours of its fill and its line.
struct PathPaint {
  std::optional<PageColor> fill, line;
  [[nodiscard]] bool is_seen() const { return fill || line; }
};
[[nodiscard]] PathPaint paint_of(const PageGroup& group, std::size_t path);

}  // namespace frontmost::detail
