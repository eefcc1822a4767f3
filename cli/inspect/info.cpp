// SPDX-License-Identifier: Apache-2.0
// frontmost info: what is in a model.
#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inspect/info_report.h"
#include "cli/model.h"

namespace frontmost::cli {

int run_info(const Settings& settings) {
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress);
  const SceneReport report = inspect(scene, execution);
  // Built-in scenes have no size in the world.
  const bool is_file = scene.source.format.has_value();
  const auto unit = is_file ? unit_of_model(report, scene.source.metres_per_unit) : std::nullopt;
  progress.clear();
  print(settings.run.json ? dump(info_json(report, unit)) : info_text(report, unit));
  return exit_done;
}

}  // namespace frontmost::cli
