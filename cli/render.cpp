// SPDX-License-Identifier: Apache-2.0
// frontmost render: pictures and maps of a model.
#include <fmt/format.h>

#include <algorithm>

#include "command.h"
#include "console.h"
#include "failure.h"
#include "interruption.h"
#include "jobs.h"
#include "json_report.h"
#include "model.h"
#include "stopwatch.h"
#include "terminal.h"

namespace frontmost::cli {
namespace {

bool has_result(const Settings& settings, const std::vector<Job>& jobs) {
  const auto makes = [](const Job& job) { return !job.files.empty() || job.output.reference || job.output.hash; };
  return settings.run.json || std::any_of(jobs.begin(), jobs.end(), makes);
}

void check_method(const Settings& settings, const std::vector<Job>& jobs) {
  if (settings.run.method == Method::zbuffer) return;
  for (const Job& job : jobs) {
    if (job.view.depth.is_used) throw UsageError("--method: a depth buffer's state needs the method zbuffer");
  }
}

/// Without any result asked for, the picture goes to the terminal, if there is one.
bool shows_on_terminal(const Settings& settings, std::vector<Job>& jobs) {
  if (has_result(settings, jobs)) return false;
  const std::optional<glm::ivec2> terminal = output_terminal();
  if (!terminal) {
    throw UsageError(
        "nothing to do: give an output such as -o FILE (without one the picture is shown on a terminal, "
        "and standard output is none)");
  }
  for (Job& job : jobs) prepare_for_terminal(job, *terminal);
  return true;
}

/// Warnings first, then the picture, so that both can be read.
void tell(const ViewResult& result, const Settings& settings, Progress& progress) {
  progress.clear();
  const std::string prefix = settings.run.batch ? result.name + ": " : "";
  if (!settings.run.quiet) {
    for (const std::string& warning : result.warnings) complain(prefix + "warning: " + warning);
  }
  if (result.reference && !result.reference->passed) {
    const ReferenceResult& reference = *result.reference;
    complain(fmt::format("{}{}: {} pixels differ, by {:.4g} at most; see {}", prefix, reference.path,
                         reference.differing_pixels, reference.largest_difference, reference.difference_path));
  }
  if (result.picture) show_on_terminal(*result.picture);
}

int status_of(const std::vector<ViewResult>& results) {
  const auto differs = [](const ViewResult& result) { return result.reference && !result.reference->passed; };
  return std::any_of(results.begin(), results.end(), differs) ? exit_differs : exit_done;
}

}  // namespace

int run_render(const Settings& settings) {
  const Stopwatch whole;
  std::vector<Job> jobs = plan_jobs(settings);
  check_method(settings, jobs);
  const bool on_terminal = shows_on_terminal(settings, jobs);
  catch_interruptions(settings.run.timeout);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  RunTimings timings;
  Stopwatch watch;
  const Scene scene = load_model(settings, execution, progress);
  timings.load = watch.milliseconds();
  watch = {};
  const Surfaces surfaces(scene, execution);
  timings.surfaces = watch.milliseconds();
  std::optional<RayIndex> index;
  if (settings.run.method == Method::raycast) {
    watch = {};
    index.emplace(surfaces, execution);
    timings.index = watch.milliseconds();
  }
  std::vector<ViewResult> results;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (jobs.size() > 1) progress.set_prefix(fmt::format("view {} of {}: ", i + 1, jobs.size()));
    results.push_back(
        render_view(jobs[i], {surfaces, settings.run, execution, on_terminal, index ? &*index : nullptr}));
    tell(results.back(), settings, progress);
    results.back().picture.reset();
    stop_if_interrupted();
  }
  timings.total = whole.milliseconds();
  if (settings.run.json) print(dump(render_json(settings, surfaces, results, timings)));
  if (!settings.run.json) print(hash_lines(results, settings.run.batch.has_value()));
  return status_of(results);
}

}  // namespace frontmost::cli
