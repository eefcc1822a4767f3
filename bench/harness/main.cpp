// SPDX-License-Identifier: Apache-2.0
// zbuffer_bench [TABLE]... [--scene NAME]... [--threads N] [--rounds N] [--large] [--no-peers] [--json FILE]
// Measures the z-buffer beside its peers and its own promises; docs/performance.md says what the tables mean.
#include <frontmost/base.h>

#include <cstdio>

#include "harness/peer_process.h"
#include "harness/scenes.h"
#include "harness/tables.h"

namespace {

using namespace frontmost::bench;

struct Entry {
  const char* name;
  Table (*measure)(const Options&);
};
constexpr Entry kTables[] = {
    {"peers", measure_peers},       {"threads", measure_threads},   {"isas", measure_isas},
    {"stages", measure_stages},     {"features", measure_features}, {"limits", measure_limits},
    {"memory", measure_memory},     {"surfaces", measure_surfaces}, {"coverage", measure_coverage},
    {"rays", measure_ray_coverage}, {"raycast", measure_raycast},   {"depth", measure_depth_buffer}};

void write_json(const std::string& path, const std::vector<Table>& tables) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) throw frontmost::Error(frontmost::ErrorCode::file_unwritable, path + ": cannot be written");
  for (std::size_t i = 0; i < tables.size(); ++i)
    std::fprintf(file, "%s%s", i == 0 ? "[" : ",\n", tables[i].json().c_str());
  std::fprintf(file, "]\n");
  std::fclose(file);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count == 7 && std::string_view(arguments[1]) == "--serve") {
    serve_peer(arguments + 2);
    return 0;
  }
  const Options options = parse_options(count, arguments);
  for (const std::string& name : options.scenes) (void)find_scene(name);
  std::vector<Table> tables;
  for (const auto& [name, measure] : kTables)
    if (options.wants(name)) tables.push_back(measure(options));
  if (!options.json.empty()) write_json(options.json, tables);
  for (const Table& table : tables)
    if (!table.holds()) return 1;
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "zbuffer_bench: %s\n", error.what());
  return 1;
}
