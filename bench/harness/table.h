// SPDX-License-Identifier: Apache-2.0
// Tables of results. Rows are printed as they come, because a table may take an hour, and kept for a JSON file. All
// columns but the first have one width.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace frontmost::bench {

struct Cell {
  std::string text;  ///< as printed
  std::string json;  ///< as a JSON value

  Cell(const char* word);
  Cell(std::string_view word);
  Cell(const std::string& word) : Cell(std::string_view(word)) {}
  Cell(double number, int decimals = 2);  ///< NaN: left empty
  static Cell whole(unsigned long long number);
};

/// One table, with columns of one width. Rows are printed at once, so that a long run shows its progress.
class Table {
 public:
  Table(std::string name, std::vector<std::string> columns);
  void add(const std::vector<Cell>& cells);
  [[nodiscard]] std::string json() const;
  /// Reports that a row breaks a promise that does not depend on the machine's speed.
  void fail() { holds_ = false; }
  [[nodiscard]] bool holds() const { return holds_; }

 private:
  std::string name_;
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
  bool holds_ = true;
};

}  // namespace frontmost::bench
