// SPDX-License-Identifier: Apache-2.0
// frontmost info: what is in a model.
#include "command.h"
#include "console.h"
#include "failure.h"
#include "info_report.h"
#include "interruption.h"
#include "model.h"

namespace frontmost::cli {

int run_info(const Settings& settings) {
  catch_interruptions(settings.run.timeout);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress);
  const SceneReport report = inspect(scene, execution);
  progress.clear();
  print(settings.run.json ? dump(info_json(report)) : info_text(report));
  return exit_done;
}

}  // namespace frontmost::cli
