// SPDX-License-Identifier: Apache-2.0
// frontmost camera: prints one camera in every convention.
#include <frontmost/scene.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/view/camera_report.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {

int run_camera(const Settings& settings) {
  check_view_settings(settings.view);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress);
  const Surfaces surfaces(scene, execution);
  const View view = resolve_view(settings.view, surfaces);
  const glm::dvec3 target = focal_point_of(settings.view, view, surfaces);
  show_framing_warning(settings, surfaces, progress);
  progress.clear();
  print(settings.run.json ? dump(camera_json(view, target, scene.origin)) : camera_text(view, target, scene.origin));
  return exit_done;
}

}  // namespace frontmost::cli
