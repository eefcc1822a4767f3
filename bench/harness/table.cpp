// SPDX-License-Identifier: Apache-2.0
#include "harness/table.h"

#include <cmath>
#include <cstdio>

namespace frontmost::bench {
namespace {

constexpr std::size_t kFirstWidth = 30, kWidth = 12;

void print_cell(std::size_t column, const std::string& text) {
  if (column == 0)
    std::printf("%-*s", int(kFirstWidth), text.c_str());
  else
    std::printf(" %*s", int(kWidth), text.c_str());
}

}  // namespace

Cell::Cell(const char* word) : Cell(std::string_view(word)) {}
Cell::Cell(std::string_view word) : text(word), json("\"") { json.append(word).append("\""); }
Cell::Cell(double number, int decimals) : json("null") {
  if (std::isnan(number)) return;
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, number);
  text = buffer;
  std::snprintf(buffer, sizeof buffer, "%.6g", number);
  json = buffer;
}
Cell Cell::whole(unsigned long long number) {
  Cell cell(std::to_string(number));
  cell.json = cell.text;
  return cell;
}

Table::Table(std::string name, std::vector<std::string> columns)
    : name_(std::move(name)), columns_(std::move(columns)) {
  std::printf("\n== %s\n", name_.c_str());
  for (std::size_t i = 0; i < columns_.size(); ++i) print_cell(i, columns_[i]);
  std::printf("\n");
  std::fflush(stdout);
}

void Table::add(const std::vector<Cell>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) print_cell(i, cells[i].text);
  std::printf("\n");
  std::fflush(stdout);
  rows_.push_back(cells);
}

std::string Table::json() const {
  std::string text = "{\"table\": \"";
  text.append(name_).append("\", \"rows\": [");
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    text.append(r == 0 ? "\n  {" : ",\n  {");
    for (std::size_t i = 0; i < rows_[r].size(); ++i)
      text.append(i == 0 ? "\"" : ", \"").append(columns_[i]).append("\": ").append(rows_[r][i].json);
    text.append("}");
  }
  return text.append("]}");
}

}  // namespace frontmost::bench
