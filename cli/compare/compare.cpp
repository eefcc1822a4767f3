// SPDX-License-Identifier: Apache-2.0
// frontmost compare: all visibility methods on one view, side by side.
//
//   for each method: a process of its own --answer, times, memory--> agreement with the first --> text, JSON, or a page
//
// The methods' processes start before this one has threads, because a process with threads cannot be forked safely.
// This process compares the answers afterwards.
#include <frontmost/base.h>

#include <filesystem>
#include <optional>

#include "cli/command.h"
#include "cli/compare/compare_report.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/option.h"
#include "cli/outputs.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

constexpr Option compare_options[] = {
    {"output", 'o', "FOLDER", "Write index.html and its pictures into this folder; a missing folder is made.",
     Group::compare, for_compare,
     [](Settings& s, const Given& g) {
       if (g.text.empty()) throw UsageError("the folder's name is empty");
       s.compare.folder = g.string();
     }},
    {"runs", 0, "N", "Run every method N times and report medians; by default 5 times, or until a run takes over 2 s.",
     Group::compare, for_compare,
     [](Settings& s, const Given& g) {
       s.compare.runs = g.integer({1, 1e4});
     }},
    {"explain", 0, "", "Print in words which method suits this scene and this machine.", Group::compare, for_compare,
     [](Settings& s, const Given&) { s.compare.explain = true; }},
};

void check(const Settings& settings) {
  check_view_settings(settings.view);
  // Each method reads the model in its own process.
  if (settings.view.samples.value_or(1) > 16) throw UsageError("--samples: compare takes 1, 2, 4, 8 or 16");
  if (settings.model == "-") throw UsageError("the command compare reads its model several times: give a file");
}

/// Returns the files of the page, or none unless a page is asked for.
std::vector<std::string> outputs_of(const Settings& settings) {
  std::vector<std::string> paths;
  if (!settings.compare.folder) return paths;
  for (const std::string& name : page_names())
    paths.push_back((std::filesystem::path(*settings.compare.folder) / name).string());
  return paths;
}

Agreement agreement_of(const MethodRun& run, const Visible& reference, const Surfaces& surfaces,
                       const Execution& execution) {
  Agreement result = check_agreement(surfaces, reference, run.answer.visible, execution);
  if (run.answer.behind) see_through(result, surfaces, run.answer.visible, *run.answer.behind);
  return result;
}

}  // namespace

std::span<const Option> compare_option_table() { return compare_options; }

int run_compare(const Settings& settings) {
  check(settings);
  std::optional<MadeFolder> folder;
  if (settings.compare.folder) folder.emplace(*settings.compare.folder);
  const std::vector<std::string> outputs = outputs_of(settings);
  check_outputs(outputs, input_files(settings));
  // The methods' processes come first, because a process that has threads cannot be forked.
  std::vector<MethodRun> runs;
  for (const ComparedMethod& method : compared_methods()) {
    runs.push_back(run_alone(method, settings));
    stop_if_interrupted();
  }
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress, outputs);
  const View& view = runs.front().answer.visible.view;
  const std::optional<Scene> cut = tessellated(scene, settings.view, view);
  const Surfaces surfaces(cut ? *cut : scene, execution);
  show_framing_warning(settings, surfaces, progress);
  Comparisons all{settings, surfaces, view, {}, {}, {}};
  for (MethodRun& run : runs) {
    const Visible& reference = all.methods.empty() ? run.answer.visible : all.methods.front().run.answer.visible;
    Agreement agreement = agreement_of(run, reference, surfaces, execution);
    all.methods.push_back({std::move(run), std::move(agreement)});
    stop_if_interrupted();
  }
  all.culling = run_culling(surfaces, all.methods.front().run.answer.visible, settings.compare.most_runs(), execution);
  if (settings.compare.folder) write_page(all, *settings.compare.folder, execution);
  all.files = outputs;
  progress.clear();
  print(settings.run.json ? dump(compare_json(all)) : compare_text(all));
  return exit_done;
}

}  // namespace frontmost::cli
