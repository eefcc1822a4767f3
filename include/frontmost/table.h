// SPDX-License-Identifier: Apache-2.0
// Tables of numbers, as files: a row for each thing, a column for each number that is known of it.
//
//   primitive,object,triangle,pixels        CSV: names, then a line for each row
//   0,0,0,12.5                              NPY: an array of records, whose fields are the columns
//   7,1,3,0.25
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "frontmost/base.h"

namespace frontmost {

struct TableColumn {
  /// Letters, digits and underscores.
  std::string name;
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint32_t>, std::vector<double>> values;

  [[nodiscard]] std::size_t size() const;
};

struct Table {
  std::vector<TableColumn> columns;  ///< all of one size

  /// How many; 0 without columns.
  [[nodiscard]] std::size_t row_count() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// \throws Error bad_argument for columns of different sizes and names that are empty or hold other characters.
void validate(const Table& table);

enum class TableFormat : std::uint8_t { csv, npy };

/// Writes a table, whole or not at all; "-" is standard output. CSV (RFC 4180, lines end in a line feed) has names in
/// its first line and numbers with as many digits as make the same number again. NPY is a structured array of one
/// dimension, little-endian, its fields packed: `numpy.load(path)["pixels"]` is a column.
/// O(rows x columns). \throws Error file_unwritable, and as validate() does.
void save(const Table& table, const std::string& path, TableFormat format);

}  // namespace frontmost
