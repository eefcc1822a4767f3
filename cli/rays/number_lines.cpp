// SPDX-License-Identifier: Apache-2.0
#include "cli/rays/number_lines.h"

#include <fmt/format.h>
#include <frontmost/io.h>

#include <algorithm>

#include "cli/failure.h"
#include "cli/values.h"

namespace frontmost::cli {
namespace {

constexpr std::uint64_t most_bytes = std::uint64_t(1) << 30;
constexpr std::size_t most_lines = std::size_t(1) << 22;
constexpr std::string_view blanks = " \t\r\v\f,";

double number_at(std::string_view word, const std::string& path, std::size_t line) {
  try {
    return parse_number(word, {-3e38, 3e38});
  } catch (const UsageError& error) {
    throw Error(ErrorCode::file_malformed, fmt::format("{}: line {}: {}", path, line, error.what()));
  }
}

std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace

std::vector<double> read_number_lines(const std::string& path, const LineRule& rule) {
  const std::string text = load_text(path, most_bytes);
  std::vector<double> numbers;
  std::size_t lines = 0;
  std::string_view rest = text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t length = rest.find('\n');
    std::string_view line = rest.substr(0, length);
    rest.remove_prefix(length == std::string_view::npos ? rest.size() : length + 1);
    line = line.substr(0, line.find('#'));
    std::size_t count = 0;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line), ++count)
      if (count < rule.count) numbers.push_back(number_at(word, path, number));
    if (count == 0) continue;
    if (count != rule.count)
      throw Error(ErrorCode::file_malformed,
                  fmt::format("{}: line {}: {}; there are {}", path, number, rule.text, count));
    if (++lines > most_lines)
      throw Error(ErrorCode::limit_exceeded,
                  fmt::format("{}: line {}: more than the limit of {} lines", path, number, most_lines));
  }
  return numbers;
}

}  // namespace frontmost::cli
