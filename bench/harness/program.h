// SPDX-License-Identifier: Apache-2.0
// A benchmark program: tables to choose from, printed as they come and kept as JSON.
#pragma once

#include <span>

#include "harness/options.h"
#include "harness/table.h"

namespace frontmost::bench {

struct TableEntry {
  std::string_view name;
  Table (*measure)(const Options&);
};

/// NAME [TABLE]... [flags as in options.h]: measures the tables that are asked for, or all. Also the other end of
/// PeerProcess. \returns what main() returns: 1 after an error and where a table does not hold.
int run_program(const char* name, std::span<const TableEntry> entries, int count, char** arguments);

}  // namespace frontmost::bench
