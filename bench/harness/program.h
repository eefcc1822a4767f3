// SPDX-License-Identifier: Apache-2.0
// The main program of all measurements: reads options, runs the tables that they name, and prints the tables.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/measure.h"
#include "harness/scenes.h"
#include "harness/table.h"

namespace frontmost::bench {

struct Options {
  std::vector<std::string> tables;  ///< empty: all
  std::vector<std::string> scenes;  ///< empty: the table's own scenes
  std::string models;               ///< folder of test models
  std::string json;                 ///< file for the results; empty: not written
  int grid = -1;                    ///< sub-samples along a pixel's side of the A-buffer; -1: all
  int threads = 1;                  ///< for the tables `peers` and `stages`
  bool large = false;               ///< includes the scenes of 16 million triangles
  bool llvmpipe = true, embree = true;
  Sampling sampling;

  [[nodiscard]] bool wants(std::string_view table) const;
  /// Whether the scene is named, or, if no scene is named, not too large.
  [[nodiscard]] bool wants_scene(const SceneEntry& entry) const;
  /// The named scenes, or `own` if none is named.
  [[nodiscard]] std::vector<std::string_view> scenes_or(std::span<const std::string_view> own) const;
};

struct TableEntry {
  std::string_view name;
  Table (*measure)(const Options&);
};

/// Command NAME [TABLE]... [flags as in Options]: measures the named tables, or all. Also runs the other end of
/// PeerProcess. \returns the status for main(): 1 after an error or if a table fails.
int run_program(const char* name, std::span<const TableEntry> entries, int count, char** arguments);

}  // namespace frontmost::bench
