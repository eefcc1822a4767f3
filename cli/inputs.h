// SPDX-License-Identifier: Apache-2.0
// Input files of a run: the model and others. No output may replace an input.
#pragma once

#include <frontmost/scene.h>

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/console.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// Files are identified by device and inode, so that links of either kind lead to the same file.
class InputFiles {
 public:
  /// Adds a file. `is` describes an output of the same name: "is the model itself". A file that is missing or not
  /// ordinary cannot be replaced and is ignored.
  void add(const std::filesystem::path& path, const std::string& is);
  /// Compares outputs with these files. \throws UsageError naming the first output that equals one of the files.
  void refuse_outputs(const std::vector<std::string>& outputs) const;

 private:
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::string> files_;  // by device and inode
};

/// Whether the environment is a file, not a built-in one.
[[nodiscard]] bool is_environment_file(const LightSettings& light);
/// Returns all files that the settings name. \throws UsageError if two of them are standard input.
[[nodiscard]] InputFiles input_files(const Settings& settings);

/// Checks the files that a model uses, such as material libraries, buffers and textures. They are known after the model
/// was read. \throws UsageError if an output would replace one of them.
void refuse_outputs_beside(const std::vector<std::filesystem::path>& used, const std::vector<std::string>& outputs);

/// Returns an Execution with the requested threads and instruction set, which reports interruptions.
[[nodiscard]] Execution execution_for(const RunSettings& settings, const Progress& progress);
/// Loads the model and prints the reader's warnings to standard error unless quiet: a few, then the number of others.
/// \throws UsageError if one of `outputs` would replace a file that the model uses, such as a texture.
[[nodiscard]] Scene load_model(const Settings& settings, const Execution& execution, Progress& progress,
                               const std::vector<std::string>& outputs = {});
/// Prints warnings to standard error unless quiet: a few, then the number of others.
void show_warnings(const std::vector<std::string>& warnings, const RunSettings& run, Progress& progress);
/// Prints framing_warning() and up_warning(): objects reach out of the picture, or the model lies on its back.
void show_framing_warning(const Settings& settings, const Surfaces& surfaces, Progress& progress);
/// Returns the scene with its curved meshes cut into triangles for `view`, with the error that --tessellation-error
/// allows. Returns nothing without that option.
[[nodiscard]] std::optional<Scene> tessellated(const Scene& scene, const ViewSettings& settings, const View& view);

}  // namespace frontmost::cli
