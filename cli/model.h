// SPDX-License-Identifier: Apache-2.0
// Reading the model, and passing on what the reader had to say.
#pragma once

#include <frontmost/scene.h>

#include "cli/progress.h"
#include "cli/settings.h"

namespace frontmost::cli {

[[nodiscard]] Execution execution_for(const RunSettings& settings, const Progress& progress);
/// Loads, and prints the reader's warnings to standard error unless quiet: a few, then how many more.
/// \throws UsageError when a file that a model uses, such as a texture, is one of `outputs`.
[[nodiscard]] Scene load_model(const Settings& settings, const Execution& execution, Progress& progress,
                               const std::vector<std::string>& outputs = {});
/// The same of warnings alone.
void show_warnings(const std::vector<std::string>& warnings, const RunSettings& run, Progress& progress);
/// The scene with its curved meshes cut for `view`, where --tessellation-error says how finely; none otherwise.
[[nodiscard]] std::optional<Scene> tessellated(const Scene& scene, const ViewSettings& settings, const View& view);

}  // namespace frontmost::cli
