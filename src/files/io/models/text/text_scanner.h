// SPDX-License-Identifier: Apache-2.0
// Walks over a text file word by word and counts its lines.
//
//        v 1.5  -2  0  # left rim          word() takes "v", number() 1.5, and at_line_end() is true at the comment
//               ^ at_                      place() is "line 7", for messages
//
// All readers of text use these few steps. No step copies, allocates, or reads beyond the bytes: a mapped file has no
// zero at its end.
#pragma once

#include <string_view>

#include "io/models/model_source.h"
#include "io/models/reader.h"
#include "io/models/text/number.h"

namespace frontmost {

/// Lines end with \n, \r\n or \r. If `comments` says so, a word that starts with '#' ends its line. A backslash at the
/// end of a line joins it with the next one. Every step stays within the bytes; none looks for a terminator.
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

  /// The next word of this line; empty at its end.
  std::string_view word() {
    if (at_line_end()) return {};
    const char* const start = at_;
    while (at_ != end_ && !is_space(*at_)) ++at_;
    return {start, std::size_t(at_ - start)};
  }
  /// The rest of the line, with comments, without blanks around it.
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
