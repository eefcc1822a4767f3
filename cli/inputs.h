// SPDX-License-Identifier: Apache-2.0
// What a run reads: the model, and the other files, none of which an output may replace.
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

/// Whether the environment is read from a file, and not made by code.
[[nodiscard]] bool is_environment_file(const LightSettings& light);
/// All that the settings name. \throws UsageError where standard input would be read for two of them.
[[nodiscard]] InputFiles input_files(const Settings& settings);

/// What a model turned out to use, known when it has been read: its material libraries, buffers and textures.
/// \throws UsageError when one of them is an output.
void refuse_outputs_beside(const std::vector<std::filesystem::path>& used, const std::vector<std::string>& outputs);

/// How the library is to run: with the threads and instructions that were asked for, and told of interruptions.
[[nodiscard]] Execution execution_for(const RunSettings& settings, const Progress& progress);
/// Loads, and prints the reader's warnings to standard error unless quiet: a few, then how many more.
/// \throws UsageError when a file that a model uses, such as a texture, is one of `outputs`.
[[nodiscard]] Scene load_model(const Settings& settings, const Execution& execution, Progress& progress,
                               const std::vector<std::string>& outputs = {});
/// The same of warnings alone.
void show_warnings(const std::vector<std::string>& warnings, const RunSettings& run, Progress& progress);
/// The same of objects that reach out of the picture, and of a model that lies on its back: framing_warning(),
/// up_warning().
void show_framing_warning(const Settings& settings, const Surfaces& surfaces, Progress& progress);
/// The scene with its curved meshes cut for `view`, where --tessellation-error says how finely; none otherwise.
[[nodiscard]] std::optional<Scene> tessellated(const Scene& scene, const ViewSettings& settings, const View& view);

}  // namespace frontmost::cli
