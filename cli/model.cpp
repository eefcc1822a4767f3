// SPDX-License-Identifier: Apache-2.0
#include "cli/model.h"

#include <fmt/format.h>
#include <frontmost/io.h>
#include <frontmost/tessellate.h>

#include "cli/console.h"
#include "cli/input_files.h"

namespace frontmost::cli {

constexpr std::size_t warnings_shown = 5;

Execution execution_for(const RunSettings& settings, const Progress& progress) {
  return {settings.threads, settings.isa, progress.watch()};
}

Scene load_model(const Settings& settings, const Execution& execution, Progress& progress,
                 const std::vector<std::string>& outputs) {
  Scene scene = load(settings.model, settings.load, execution);
  for (const std::string& model : settings.more_models) add(scene, load(model, settings.load, execution));
  refuse_outputs_beside(scene.source.files, outputs);
  show_warnings(scene.warnings, settings.run, progress);
  return scene;
}

void show_warnings(const std::vector<std::string>& warnings, const RunSettings& run, Progress& progress) {
  if (run.quiet) return;
  progress.clear();
  for (std::size_t i = 0; i < warnings.size() && i < warnings_shown; ++i) complain("warning: " + warnings[i]);
  if (warnings.size() > warnings_shown) {
    complain(fmt::format("warning: and {} more like these; --json lists them", warnings.size() - warnings_shown));
  }
}

std::optional<Scene> tessellated(const Scene& scene, const ViewSettings& settings, const View& view) {
  if (!settings.tessellation_error || !has_curved(scene)) return std::nullopt;
  return tessellate(scene, view, *settings.tessellation_error);
}

}  // namespace frontmost::cli
