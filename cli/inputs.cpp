// SPDX-License-Identifier: Apache-2.0
// Files are compared by device and inode, not by name: an output that links to the model would replace it as well. The
// files that a model uses are known after it was read, and are compared then.
#include "cli/inputs.h"

#include <fmt/format.h>
#include <frontmost/files.h>
#include <frontmost/view.h>
#include <sys/stat.h>

#include <optional>

#include "cli/console.h"
#include "cli/failure.h"
#include "cli/view/up_axis.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

constexpr std::size_t warnings_shown = 5;

std::optional<std::pair<std::uint64_t, std::uint64_t>> identity(const char* path) {
  struct ::stat status {};
  if (::stat(path, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return std::pair(std::uint64_t(status.st_dev), std::uint64_t(status.st_ino));
}

}  // namespace

void InputFiles::add(const std::filesystem::path& path, const std::string& is) {
  if (const auto file = identity(path.c_str())) files_.try_emplace(*file, is);
}

void InputFiles::refuse_outputs(const std::vector<std::string>& outputs) const {
  for (const std::string& output : outputs) {
    if (output == "-") continue;
    const auto file = identity(output.c_str());
    const auto found = file ? files_.find(*file) : files_.end();
    if (found != files_.end()) throw UsageError(fmt::format("{}: {}", output, found->second));
  }
}

bool is_environment_file(const LightSettings& light) {
  return light.environment && *light.environment != "studio" && *light.environment != "sky" &&
         *light.environment != "none";
}

InputFiles input_files(const Settings& settings) {
  InputFiles files;
  const char* of_input = nullptr;
  const auto add = [&](const std::optional<std::string>& path, const char* is) {
    if (!path) return;
    files.add(*path, is);
    if (*path != "-") return;
    if (of_input)
      throw UsageError(fmt::format("-: standard input {}, and cannot be read twice; give a file", of_input));
    of_input = is;
  };
  add(settings.model, "is the model itself");
  for (const std::string& more : settings.more_models) add(more, "is the model itself");
  add(settings.run.batch, "is the batch file itself");
  add(settings.visible.views, "is the file of views itself");
  add(settings.report.views, "is the file of views itself");
  add(settings.report.categories, "is the file of categories itself");
  add(settings.sight.pairs, "is the file of pairs itself");
  add(settings.lidar.directions, "is the file of directions itself");
  add(settings.view.pose_file, "is the pose file itself");
  if (is_environment_file(settings.output.light)) add(settings.output.light.environment, "is the environment itself");
  add(settings.output.reference, "is both the reference and an output");
  return files;
}

void refuse_outputs_beside(const std::vector<std::filesystem::path>& used, const std::vector<std::string>& outputs) {
  InputFiles files;
  for (const std::filesystem::path& path : used) files.add(path, "is a file that the model uses");
  files.refuse_outputs(outputs);
}

Execution execution_for(const RunSettings& settings, const Progress& progress) {
  return {settings.threads, settings.isa, progress.watch()};
}

Scene load_model(const Settings& settings, const Execution& execution, Progress& progress,
                 const std::vector<std::string>& outputs) {
  Scene scene = load(settings.model, settings.load, execution);
  for (const std::string& model : settings.more_models) add(scene, load(model, settings.load, execution));
  if (settings.report.categories) load_categories(*settings.report.categories, scene);
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

void show_framing_warning(const Settings& settings, const Surfaces& surfaces, Progress& progress) {
  for (const auto& warning :
       {framing_warning(settings.view, surfaces), up_warning(settings.view, settings.load, surfaces)})
    if (warning) show_warnings({*warning}, settings.run, progress);
}

std::optional<Scene> tessellated(const Scene& scene, const ViewSettings& settings, const View& view) {
  if (!settings.tessellation_error || !has_curved(scene)) return std::nullopt;
  return tessellate(scene, view, *settings.tessellation_error);
}

}  // namespace frontmost::cli
