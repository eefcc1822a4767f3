// SPDX-License-Identifier: Apache-2.0
// frontmost render: pictures and maps of a model.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/outputs.h"
#include "cli/render/jobs.h"
#include "cli/render/json_report.h"
#include "cli/render/output_writer.h"
#include "cli/render/ranks.h"
#include "cli/render/render_tessellated.h"
#include "cli/render/render_view.h"
#include "cli/render/shard.h"
#include "cli/stopwatch.h"
#include "cli/view/up_axis.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

bool has_result(const Settings& settings, const std::vector<Job>& jobs) {
  const auto makes = [](const Job& job) {
    return !job.files.empty() || !job.layer_files.empty() || !job.figures.empty() || job.output.reference ||
           job.output.hash;
  };
  return settings.run.json || std::any_of(jobs.begin(), jobs.end(), makes);
}

void check_method(const Settings& settings, const std::vector<Job>& jobs) {
  if (settings.run.method.value_or(Method::zbuffer) == Method::zbuffer) return;
  for (const Job& job : jobs) {
    if (job.view.depth.is_used) throw UsageError("--method: options of a depth buffer need the method zbuffer");
  }
}

/// Whether a material is transparent.
bool lets_light_through(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.is_see_through(); });
}

/// Returns a model that is a picture's name, as in "render model.obj out.png", which lacks "-o".
std::optional<std::string> picture_among_models(const Settings& settings) {
  for (const std::string& model : settings.more_models)
    if (format_by_suffix(model) || is_figure(model)) return model;
  return std::nullopt;
}

/// Whether the picture is shown on the terminal, because no other result is asked for. If so, prepares the jobs. Output
/// of MPI's ranks goes to no terminal.
bool shows_on_terminal(const Settings& settings, std::vector<Job>& jobs) {
  if (has_result(settings, jobs)) return false;
  const std::optional<glm::ivec2> terminal = settings.run.mpi ? std::nullopt : output_terminal();
  if (!terminal) {
    throw UsageError(
        fmt::format("nothing to do: give an output such as -o {} (without one the picture is shown on a terminal, and "
                    "standard output is none)",
                    picture_among_models(settings).value_or("FILE")));
  }
  for (Job& job : jobs) prepare_for_terminal(job, *terminal);
  return true;
}

/// Prints warnings before the picture, so that both can be read.
void tell(const ViewResult& result, const Settings& settings, Progress& progress) {
  progress.clear();
  const std::string prefix = settings.run.batch ? result.name + ": " : "";
  if (!settings.run.quiet) {
    for (const std::string& warning : result.warnings) complain(fmt::format("{}warning: {}", prefix, warning));
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

/// The state of a run, of a model or of a stream.
struct Run {
  const Settings& settings;
  std::vector<Job> jobs;
  bool on_terminal = false;
  Stopwatch whole;
  Team team{};
  std::optional<ShardRun> shard{};

  /// Keeps only the unfinished jobs of the shard. `used` are the files of the model.
  void choose_jobs(const std::vector<std::filesystem::path>& used) {
    if (!settings.run.shard) return;
    shard.emplace(settings, jobs, used);
    jobs = shard->remaining(std::move(jobs));
  }
  [[nodiscard]] std::optional<std::size_t> finished_before() const {
    if (!shard) return std::nullopt;
    return shard->finished_count();
  }
};

/// Whether the z-buffer draws the model more than once, shadows aside, so that clusters pay off from the start.
bool is_drawn_often(const Run& run) {
  std::size_t count = 0;
  for (const Job& job : run.jobs) count += views_of({}, plan_sights(job, run.settings.run, run.on_terminal, {})).size();
  return count * std::size_t(run.settings.run.repeat) > 1;
}

/// Returns a warning about the model's own lights, if a lit picture ignores them and the user may not know it.
std::optional<std::string> lights_warning(const Scene& scene, const Job& job) {
  if (job.output.shading != Shading::lit || !writes_colors(job)) return std::nullopt;
  if (scene.lights.empty() && job.output.lights == Lights::file)
    return "the model has no lights of its own, so --lights file leaves only the environment's light";
  if (scene.lights.empty()) return std::nullopt;
  const std::size_t count = scene.lights.size();
  const std::string own =
      count == 1 ? "the model has a light of its own" : fmt::format("the model has {} lights of its own", count);
  if (!job.output.lights) return own + "; use --lights file or --lights both";
  if (job.output.shadows != Shadows::map || *job.output.lights == Lights::key || *job.output.lights == Lights::none)
    return std::nullopt;
  const auto points = std::size_t(std::count_if(scene.lights.begin(), scene.lights.end(),
                                                [](const Light& light) { return light.kind == Light::Kind::point; }));
  const std::size_t without = points + std::max(count - points, most_mapped_lights) - most_mapped_lights;
  if (without == 0) return std::nullopt;
  if (count == 1) return own + " that casts no shadow with --shadows map; use --shadows rays";
  return fmt::format("{}, of which {} cast no shadows with --shadows map; use --shadows rays", own, without);
}

/// Renders each job by `render` and prints its messages.
template <class Render>
std::vector<ViewResult> render_all(const Run& run, Progress& progress, const Render& render) {
  const std::vector<Job>& jobs = run.jobs;
  const Settings& settings = run.settings;
  std::vector<ViewResult> results;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (jobs.size() > 1) progress.set_prefix(fmt::format("view {} of {}: ", i + 1, jobs.size()));
    try {
      results.push_back(render(jobs[i]));
    } catch (const Error& error) {
      if (!settings.run.batch || names_culprit(error)) throw;
      throw error.within(*settings.run.batch, "view " + jobs[i].name);
    }
    if (run.shard) run.shard->note(jobs[i]);
    tell(results.back(), settings, progress);
    results.back().picture.reset();
    stop_if_interrupted();
  }
  return results;
}

void report(const Settings& settings, const ModelFacts& model, const std::vector<Job>& jobs,
            const std::vector<ViewResult>& results, const RunTimings& timings) {
  if (settings.run.json) print(dump(render_json(settings, model, jobs, results, timings)));
  if (!settings.run.json) print(hash_lines(results, settings.run.batch.has_value()));
}

/// Returns the reader's warnings, and at most one warning each about framing, lights and up axis, which it also prints.
std::vector<std::string> model_warnings(const std::vector<Job>& jobs, const Surfaces& surfaces,
                                        const Settings& settings, Progress& progress) {
  std::vector<std::string> warnings = surfaces.scene().warnings;
  const auto tell_once = [&](const std::optional<std::string>& warning) {
    if (!warning) return false;
    show_warnings({*warning}, settings.run, progress);
    warnings.push_back(*warning);
    return true;
  };
  // Framing is the same for all views that are fitted to the subject.
  const auto fitted =
      std::find_if(jobs.begin(), jobs.end(), [](const Job& job) { return is_fitted_to_subject(job.view); });
  if (fitted != jobs.end()) tell_once(framing_warning(fitted->view, surfaces));
  for (const Job& job : jobs)
    if (tell_once(lights_warning(surfaces.scene(), job))) break;
  // The warning holds for all views, because it is the model that lies.
  const auto upright = std::find_if(jobs.begin(), jobs.end(), [](const Job& job) { return depends_on_up(job.view); });
  if (upright != jobs.end()) tell_once(up_warning(upright->view, settings.load, surfaces));
  return warnings;
}

int render_whole(Run& run) {
  const Settings& settings = run.settings;
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  RunTimings timings;
  Stopwatch watch;
  const Scene scene = load_model(settings, execution, progress, output_paths(run.jobs));
  timings.load = watch.milliseconds();
  run.choose_jobs(scene.source.files);
  watch = {};
  const Surfaces surfaces(scene, execution);
  const std::vector<std::string> warnings = model_warnings(run.jobs, surfaces, settings, progress);
  const bool is_often = is_drawn_often(run);
  if (is_often) surfaces.make_clusters(execution);
  timings.surfaces = watch.milliseconds();
  watch = {};
  std::optional<RayIndex> index;
  if (std::any_of(run.jobs.begin(), run.jobs.end(),
                  [&](const Job& job) { return needs_index(job, settings.run) && !is_tessellated(job, scene); })) {
    index.emplace(surfaces, execution);
    timings.index = watch.milliseconds();
  }
  SharedBuffers buffers;
  Shader shader(surfaces);
  LineDrawer line_drawer(surfaces);
  Environments environments;
  const std::vector<ViewResult> results = render_all(run, progress, [&](const Job& job) {
    RenderContext context{surfaces, shader, environments, settings.run, execution, run.on_terminal};
    context.by_rays = settings.run.method == Method::raycast;
    if (index) context.index = &*index;
    if (is_often) context.buffers = &buffers;
    context.line_drawer = &line_drawer;
    if (is_tessellated(job, scene)) return render_tessellated_view(job, context);
    return render_view(job, context);
  });
  timings.total = run.whole.milliseconds();
  report(settings,
         {surfaces.primitive_count(), warnings, lets_light_through(scene), std::nullopt, scene.origin,
          scene.lights.size(), run.finished_before()},
         run.jobs, results, timings);
  return status_of(results);
}

int render_stream(Run& run) {
  const Settings& settings = run.settings;
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  RunTimings timings;
  const Stopwatch watch;
  std::vector<std::string> models = {settings.model};
  models.insert(models.end(), settings.more_models.begin(), settings.more_models.end());
  StreamOptions options;
  options.load = settings.load;
  options.ranks = run.team.ranks;
  options.readers = run.team.readers;
  Stream stream(models, options, execution);
  refuse_outputs_beside(stream.scene().source.files, output_paths(run.jobs));
  run.choose_jobs(stream.scene().source.files);
  timings.load = watch.milliseconds();
  Environments environments;
  bool is_first = true;
  const std::vector<ViewResult> results = render_all(run, progress, [&](const Job& job) {
    ViewResult result =
        render_streamed_view(job, stream, {environments, settings.run, execution, run.on_terminal, options.ranks});
    // The stream's warnings are complete now, and come before those of the view, as without --stream.
    if (std::exchange(is_first, false)) show_warnings(stream.scene().warnings, settings.run, progress);
    return result;
  });
  timings.total = run.whole.milliseconds();
  if (!run.team.is_first()) return exit_done;
  report(settings,
         {stream.triangle_count(), stream.scene().warnings, false, stream.passes(), stream.scene().origin, 0,
          run.finished_before()},
         run.jobs, results, timings);
  return status_of(results);
}

int render(const Settings& settings, const Team& team) {
  if (settings.run.stream && settings.run.repeat > 1) throw UsageError("--stream and --repeat exclude each other");
  if (settings.run.stream && settings.run.method.value_or(Method::zbuffer) != Method::zbuffer)
    throw UsageError("--stream draws with --method zbuffer only");
  if (settings.run.mpi && settings.run.shard)
    throw UsageError("--mpi and --shard exclude each other: ranks share a model, shards share views");
  Run run{settings, plan_jobs(settings), false, {}, team, {}};
  check_method(settings, run.jobs);
  run.on_terminal = shows_on_terminal(settings, run.jobs);
  read_references(run.jobs);
  return settings.run.stream ? render_stream(run) : render_whole(run);
}

}  // namespace

int run_render(const Settings& settings) {
  if (!settings.run.mpi) return render(settings, {});
  // Before MPI starts, which may not be there.
  if (settings.output.edges) throw UsageError("--edges: edges need the whole model in one process; leave out --mpi");
  return run_on_ranks(settings, render);
}

}  // namespace frontmost::cli
