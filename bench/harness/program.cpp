// SPDX-License-Identifier: Apache-2.0
#include "harness/program.h"

#include <frontmost/base.h>

#include <cstdio>

#include "harness/peer_process.h"
#include "harness/scenes.h"

namespace frontmost::bench {
namespace {

void write_json(const std::string& path, const std::vector<Table>& tables) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) throw Error(ErrorCode::file_unwritable, path + ": cannot be written");
  for (std::size_t i = 0; i < tables.size(); ++i)
    std::fprintf(file, "%s%s", i == 0 ? "[" : ",\n", tables[i].json().c_str());
  std::fprintf(file, "]\n");
  std::fclose(file);
}

}  // namespace

int run_program(const char* name, std::span<const TableEntry> entries, int count, char** arguments) try {
  if (count == 7 && std::string_view(arguments[1]) == "--serve") {
    serve_peer(arguments + 2);
    return 0;
  }
  std::vector<std::string_view> names;
  for (const TableEntry& entry : entries) names.push_back(entry.name);
  const Options options = parse_options(count, arguments, names);
  for (const std::string& scene : options.scenes) (void)find_scene(scene);
  std::vector<Table> tables;
  for (const TableEntry& entry : entries)
    if (options.wants(entry.name)) tables.push_back(entry.measure(options));
  if (!options.json.empty()) write_json(options.json, tables);
  for (const Table& table : tables)
    if (!table.holds()) return 1;
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s: %s\n", name, error.what());
  return 1;
}

}  // namespace frontmost::bench
