// SPDX-License-Identifier: Apache-2.0
// What a benchmark program is asked to do.
#pragma once

#include <string>
#include <vector>

#include "harness/scenes.h"
#include "harness/stopwatch.h"

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

/// `tables`: the names that a program has. \throws Error bad_argument naming the flag.
[[nodiscard]] Options parse_options(int count, const char* const* arguments, std::span<const std::string_view> tables);

}  // namespace frontmost::bench
