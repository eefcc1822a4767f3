// SPDX-License-Identifier: Apache-2.0
// frontmost info: what is in a model.
#include <fmt/format.h>

#include "command.h"
#include "console.h"
#include "failure.h"
#include "interruption.h"
#include "model.h"
namespace frontmost::cli {
int run_info(const Settings& settings) {
  catch_interruptions(settings.run.timeout);
  Progress progress(settings.run.quiet);
  const Scene scene = load_model(settings, execution_for(settings.run, progress), progress);
  print(fmt::format("{} triangles\n", triangle_count(scene)));
  return exit_done;
}
}  // namespace frontmost::cli
