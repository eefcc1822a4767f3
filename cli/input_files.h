// SPDX-License-Identifier: Apache-2.0
// The files that a run reads, which none of its outputs may replace.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/settings.h"

namespace frontmost::cli {

/// Files are told by what they are on the disk, so that links of either kind lead to the same one.
class InputFiles {
 public:
  /// `is` says what an output of the same name would be: "is the model itself". What is no ordinary file, or is not
  /// there, cannot be replaced.
  void add(const std::filesystem::path& path, const std::string& is);
  /// \throws UsageError naming the first output that is one of them.
  void refuse_outputs(const std::vector<std::string>& outputs) const;

 private:
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::string> files_;  // by device and number there
};

/// All that the settings name. \throws UsageError where standard input would be read for two of them.
[[nodiscard]] InputFiles input_files(const Settings& settings);

/// What a model turned out to use, known when it has been read: its material libraries, buffers and textures.
/// \throws UsageError when one of them is an output.
void refuse_outputs_beside(const std::vector<std::filesystem::path>& used, const std::vector<std::string>& outputs);

}  // namespace frontmost::cli
