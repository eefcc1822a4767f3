// SPDX-License-Identifier: Apache-2.0
#include "cli/rays/number_lines.h"

#include <fmt/format.h>
#include <frontmost/base.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "cli/failure.h"
#include "cli/values.h"

namespace frontmost::cli {
namespace {

std::vector<double> numbers_of(std::string line, const LineRule& rule, const std::string& place) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::vector<double> numbers;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    try {
      numbers.push_back(parse_number(word, {-3e38, 3e38}));
    } catch (const UsageError& error) {
      throw Error(ErrorCode::file_malformed, place + ": " + error.what());
    }
  }
  if (numbers.size() != rule.count)
    throw Error(ErrorCode::file_malformed, fmt::format("{}: {}; there are {}", place, rule.text, numbers.size()));
  return numbers;
}

}  // namespace

std::vector<std::vector<double>> read_number_lines(const std::string& path, const LineRule& rule) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorCode::file_unreadable, path + ": cannot open");
  std::vector<std::vector<double>> lines;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    line.resize(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r,") == std::string::npos) continue;
    lines.push_back(numbers_of(line, rule, fmt::format("{}: line {}", path, number)));
  }
  if (file.bad()) throw Error(ErrorCode::file_unreadable, path + ": cannot read");
  return lines;
}

}  // namespace frontmost::cli
