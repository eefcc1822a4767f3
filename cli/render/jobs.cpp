// SPDX-License-Identifier: Apache-2.0
// Plans the views and files of a run, and checks which options exclude each other: layers and streams, polygons and
// depth buffers. A request that cannot be met is an error that names both options; no other file is written instead.
#include "cli/render/jobs.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/failure.h"
#include "cli/render/edges.h"
#include "cli/render/output_writer.h"
#include "cli/render/render_view.h"
#include "cli/render/shard.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

/// Checks outputs that only the A-buffer, or only a method with layers, supports.
void check_layers(const Settings& settings, const Job& job) {
  const bool has_layers = !job.layer_files.empty() || wants(job, OutputKind::deep);
  if (settings.run.stream && (has_layers || settings.output.opacity < 1))
    throw UsageError("--stream keeps only the nearest surface; it excludes --opacity, --layers and --deep");
  const bool names_other = settings.run.method && *settings.run.method != Method::abuffer;
  if ((names_other || settings.view.depth.is_used) && (has_layers || settings.output.opacity < 1))
    throw UsageError(
        "--opacity, --layers and --deep need the A-buffer; leave out --method and the options of a depth buffer");
  if (settings.view.samples == 64 && settings.run.method != Method::abuffer)
    throw UsageError("--samples 64 needs --method abuffer");
}

/// Moves pictures of polygons from the outputs to the job's figures.
void take_figures(const Settings& settings, const std::string& model, Job& job) {
  std::vector<OutputRequest>& files = job.output.files;
  const auto is_one = [](const OutputRequest& r) { return r.kind == OutputKind::picture && is_figure(r.path); };
  for (const OutputRequest& request : files)
    if (is_one(request)) job.figures.push_back(fill_template(request.path, model, job.name));
  if (job.figures.empty()) return;
  files.erase(std::remove_if(files.begin(), files.end(), is_one), files.end());
  const auto refuse = [&](const char* why) { throw UsageError(fmt::format("{}: {}", job.figures.front(), why)); };
  if (settings.run.stream) refuse("polygons need the whole model at once; leave out --stream");
  if (settings.run.method || settings.view.depth.is_used)
    refuse("polygons are always drawn by the painter's algorithm, without --method or options of a depth buffer");
  if (settings.view.camera_model != CameraModel::pinhole)
    refuse("polygons need a pinhole camera; leave out --camera-model");
  if (settings.output.light.options.shows_environment)
    refuse("polygons have a plain background; leave out --show-environment");
}

void check_format(const OutputSettings& settings) {
  if (!settings.format) return;
  std::vector<std::string> paths;
  for (const OutputRequest& request : settings.files) paths.push_back(request.path);
  check_given_format(paths, int(*settings.format), "png|exr|pfm|npy|jpg|webp|svg|pdf");
}

Job make_job(const Settings& settings) {
  if (settings.output.light.options.shows_environment && settings.output.blend != Blend::linear)
    throw UsageError("--show-environment and --blend srgb exclude each other");
  check_view_settings(settings.view);
  check_format(settings.output);
  if (settings.run.stream && settings.view.depth.is_used)
    throw UsageError("--stream draws with the default depth test; it excludes the options of a depth buffer");
  Job job{view_name(settings.view), 0, settings.said, settings.view, settings.output, {}, {}, {}, {}, {}};
  const std::string model = model_name(settings.model);
  take_figures(settings, model, job);
  for (FileToWrite& file : plan_outputs(job.output, model, job.name))
    (file.layer ? job.layer_files : job.files).push_back(std::move(file));
  check_layers(settings, job);
  check_edges(settings, job);
  check_outputs_around(job);
  if (settings.run.stream && settings.view.camera_model != CameraModel::pinhole)
    throw UsageError("--stream and --camera-model exclude each other");
  if (settings.run.stream && settings.view.framed == FramedObjects::subject)
    throw UsageError("--stream always fits all objects into the picture; it excludes --frame subject");
  if (settings.output.occlusion_radius && settings.output.ambient_occlusion == 0)
    throw UsageError("--occlusion-radius needs --ambient-occlusion");
  if (settings.run.stream && settings.output.ambient_occlusion > 0 && !settings.output.occlusion_radius)
    throw UsageError("--stream does not keep the model, so --ambient-occlusion needs --occlusion-radius");
  if (settings.run.stream && settings.output.shadows == Shadows::rays)
    throw UsageError("--stream and --shadows rays exclude each other: rays need the whole model at once");
  if (job.output.reference) {
    job.output.reference = fill_template(*job.output.reference, model, job.name);
    if (job.output.reference_difference) {
      job.output.reference_difference = fill_template(*job.output.reference_difference, model, job.name);
    }
    job.difference = difference_path(job.output, job.files);
  }
  return job;
}

void check_files(const std::vector<Job>& jobs, const Settings& settings) {
  std::vector<std::string> paths = output_paths(jobs);
  if (settings.run.shard) paths.push_back(manifest_path(settings));
  std::vector<std::string> references;
  InputFiles inputs = input_files(settings);
  for (const Job& job : jobs) {
    if (job.view.pose_file) inputs.add(*job.view.pose_file, "is the pose file itself");
    if (is_environment_file(job.output.light)) inputs.add(*job.output.light.environment, "is the environment itself");
    if (job.output.reference) references.push_back(*job.output.reference);
  }
  // A picture that is compared with itself would always pass.
  check_references(references, paths);
  check_outputs(paths, inputs);
  const bool writes_stdout = std::find(paths.begin(), paths.end(), "-") != paths.end();
  if (writes_stdout && settings.run.json)
    throw UsageError("--json and the output '-' both write to standard output; give a file");
  if (writes_stdout && settings.output.hash)
    throw UsageError("--hash and the output '-' both write to standard output; give a file");
}

}  // namespace

std::vector<std::string> output_paths(const std::vector<Job>& jobs) {
  std::vector<std::string> paths;
  for (const Job& job : jobs) {
    for (const auto* files : {&job.files, &job.layer_files})
      for (const FileToWrite& file : *files) paths.push_back(file.path);
    paths.insert(paths.end(), job.figures.begin(), job.figures.end());
    if (!job.difference.empty()) paths.push_back(job.difference);
  }
  return paths;
}

std::vector<Job> plan_jobs(const Settings& settings) {
  std::vector<Job> jobs;
  if (settings.run.batch) {
    for (const Settings& one : read_batch(*settings.run.batch, settings)) {
      try {
        jobs.push_back(make_job(one));
        jobs.back().number = jobs.size() - 1;
      } catch (const UsageError& error) {
        throw UsageError(fmt::format("{}: views[{}]: {}", *settings.run.batch, jobs.size(), error.what()));
      }
    }
  } else {
    jobs.push_back(make_job(settings));
  }
  check_shard(settings, jobs);
  check_files(jobs, settings);
  return jobs;
}

}  // namespace frontmost::cli
