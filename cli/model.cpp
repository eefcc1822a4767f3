// SPDX-License-Identifier: Apache-2.0
#include "cli/model.h"

#include <fmt/format.h>
#include <frontmost/io.h>

#include "cli/console.h"

namespace frontmost::cli {

constexpr std::size_t warnings_shown = 5;

Execution execution_for(const RunSettings& settings, const Progress& progress) {
  return {settings.threads, settings.isa, progress.watch()};
}

Scene load_model(const Settings& settings, const Execution& execution, Progress& progress) {
  Scene scene = load(settings.model, settings.load, execution);
  for (const std::string& model : settings.more_models) append(scene, load(model, settings.load, execution));
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

}  // namespace frontmost::cli
