// SPDX-License-Identifier: Apache-2.0
// Tables as CSV or NPY. Rows are written in pieces, so that a long table is not held twice.
#include "base/decimal.h"
#include "frontmost/files.h"
#include "io/binary.h"
#include "io/images/formats.h"

namespace frontmost {
namespace {

void append_text(std::string& text, const TableColumn& column, std::size_t row) {
  if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&column.values))
    text += std::to_string((*bytes)[row]);
  else if (const auto* words = std::get_if<std::vector<std::uint32_t>>(&column.values))
    text += std::to_string((*words)[row]);
  else
    text += shortest_text(std::get<std::vector<double>>(column.values)[row]);
}

void write_csv(const Table& table, OutputFile& file) {
  detail::FileBytes sink(file);
  std::string& text = sink.bytes();
  for (const TableColumn& column : table.columns) text += (text.empty() ? "" : ",") + column.name;
  text += '\n';
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    for (const TableColumn& column : table.columns) {
      append_text(text, column, row);
      text += ',';
    }
    text.back() = '\n';
    sink.pass_on();
  }
  sink.finish();
}

void write_npy(const Table& table, OutputFile& file) {
  constexpr const char* types[] = {"|u1", "<u4", "<f8"};
  std::string fields = "[";
  for (const TableColumn& column : table.columns)
    fields += (fields.size() > 1 ? ", ('" : "('") + column.name + "', '" + types[column.values.index()] + "')";
  detail::FileBytes sink(file);
  sink.bytes() = detail::npy_header(fields + "]", std::to_string(table.row_count()) + ",");
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    for (const TableColumn& column : table.columns) detail::append_bytes(sink.bytes(), column, row);
    sink.pass_on();
  }
  sink.finish();
}

}  // namespace

std::size_t TableColumn::size() const {
  return std::visit([](const auto& list) { return list.size(); }, values);
}

void validate(const Table& table) {
  constexpr std::string_view known = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  for (const TableColumn& column : table.columns) {
    if (column.name.empty() || column.name.find_first_not_of(known) != std::string::npos)
      throw Error(ErrorCode::bad_argument, "table",
                  "a column is named '" + column.name + "': letters, digits and underscores make a name");
    if (column.size() != table.row_count())
      throw Error(ErrorCode::bad_argument, "table",
                  column.name + ": has " + std::to_string(column.size()) + " rows, others have " +
                      std::to_string(table.row_count()));
  }
}

void save(const Table& table, const std::string& path, TableFormat format) {
  validate(table);
  OutputFile file(path);
  if (format == TableFormat::csv)
    write_csv(table, file);
  else
    write_npy(table, file);
  file.commit();
}

}  // namespace frontmost
