// SPDX-License-Identifier: Apache-2.0
#include "harness/options.h"

#include <frontmost/base.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace frontmost::bench {
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

}  // namespace frontmost::bench
