// SPDX-License-Identifier: Apache-2.0
// What every program of measurements does: reads its options, runs the tables that they name, and prints them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/measure.h"
#include "harness/scenes.h"
#include "harness/table.h"

namespace frontmost::bench {

struct Options {
  std::vector<std::string> tables;  ///< none: all
  std::vector<std::string> scenes;  ///< none: those that the table is about
  std::string models;               ///< folder of test models
  std::string json;                 ///< file for the results; none: not written
  int grid = -1;                    ///< of the A-buffer's sub-samples; -1: all
  int threads = 1;                  ///< of the tables `peers` and `stages`
  bool large = false;               ///< the scenes of 16 million triangles too
  bool llvmpipe = true, embree = true;
  Sampling sampling;

  [[nodiscard]] bool wants(std::string_view table) const;
  /// Named, or, where none is, not too large.
  [[nodiscard]] bool wants_scene(const SceneEntry& entry) const;
  /// Those that were named, or else a table's own.
  [[nodiscard]] std::vector<std::string_view> scenes_or(std::span<const std::string_view> own) const;
};

struct TableEntry {
  std::string_view name;
  Table (*measure)(const Options&);
};

/// NAME [TABLE]... [flags as in Options]: measures the tables that are asked for, or all. Also the other end of
/// PeerProcess. \returns what main() returns: 1 after an error and where a table does not hold.
int run_program(const char* name, std::span<const TableEntry> entries, int count, char** arguments);

}  // namespace frontmost::bench
