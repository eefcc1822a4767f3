// SPDX-License-Identifier: Apache-2.0
#include "harness/program.h"

#include <frontmost/base.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "harness/peer_process.h"
#include "harness/scenes.h"

namespace frontmost::bench {
namespace {

/// Reads the options; `tables` are the names that the program knows. \throws Error bad_argument naming the flag.
Options parse_options(int count, const char* const* arguments, std::span<const std::string_view> tables) {
  Options options;
  options.models = FRONTMOST_MODELS;
  for (int i = 1; i < count; ++i) {
    const std::string flag = arguments[i];
    const auto value = [&]() -> std::string {
      if (i + 1 >= count) throw Error(ErrorCode::bad_argument, flag + ": a value is missing");
      return arguments[++i];
    };
    if (std::find(tables.begin(), tables.end(), flag) != tables.end())
      options.tables.push_back(flag);
    else if (flag == "--scene")
      options.scenes.push_back(value());
    else if (flag == "--models")
      options.models = value();
    else if (flag == "--json")
      options.json = value();
    else if (flag == "--threads")
      options.threads = std::atoi(value().c_str());
    else if (flag == "--grid")
      options.grid = std::atoi(value().c_str());
    else if (flag == "--rounds")
      options.sampling.rounds = std::max(1, std::atoi(value().c_str()));
    else if (flag == "--seconds")
      options.sampling.most_seconds = std::atof(value().c_str());
    else if (flag == "--large")
      options.large = true;
    else if (flag == "--no-peers")
      options.llvmpipe = options.embree = false;
    else if (flag == "--no-embree")
      options.embree = false;
    else
      throw Error(ErrorCode::bad_argument, "'" + flag + "' is neither a table nor a flag; see docs/performance.md");
  }
  return options;
}

void write_json(const std::string& path, const std::vector<Table>& tables) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) throw Error(ErrorCode::file_unwritable, path + ": cannot be written");
  for (std::size_t i = 0; i < tables.size(); ++i)
    std::fprintf(file, "%s%s", i == 0 ? "[" : ",\n", tables[i].json().c_str());
  std::fprintf(file, "]\n");
  std::fclose(file);
}

}  // namespace

bool Options::wants(std::string_view table) const {
  return tables.empty() || std::find(tables.begin(), tables.end(), table) != tables.end();
}

bool Options::wants_scene(const SceneEntry& entry) const {
  if (scenes.empty()) return large || !entry.is_large;
  return std::find(scenes.begin(), scenes.end(), entry.name) != scenes.end();
}

std::vector<std::string_view> Options::scenes_or(std::span<const std::string_view> own) const {
  if (scenes.empty()) return {own.begin(), own.end()};
  return {scenes.begin(), scenes.end()};
}

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
