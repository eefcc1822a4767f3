// SPDX-License-Identifier: Apache-2.0
// frontmost report: how much of each object is visible, and which objects hide the rest.
#include <fmt/format.h>
#include <frontmost/files.h>
#include <frontmost/scene.h>
#include <frontmost/zbuffer.h>

#include <algorithm>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/option.h"
#include "cli/outputs.h"
#include "cli/report/report_datasets.h"
#include "cli/report/report_page.h"
#include "cli/report/report_run.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

std::string folder_name(const Given& given) {
  if (given.text.empty()) throw UsageError("the folder's name is empty");
  return given.string();
}

constexpr Option report_options[] = {
    {"output", 'o', "FILE", "Write the report as one HTML page, which needs no other files.", Group::report, for_report,
     [](Settings& s, const Given& g) { s.report.page = g.file_name(); }},
    {"canvas", 0, "FACTOR",
     "Width and height of the canvas on which each object is counted alone, as a multiple of the picture's, 1 to 16; 3 "
     "by default.",
     Group::report, for_report,
     [](Settings& s, const Given& g) {
       s.report.canvas = g.number({1, 16});
     }},
    {"views", 0, "FILE",
     "Report on all views of a batch file (see frontmost(1)); the outputs of the batch file are ignored.",
     Group::report, for_report, [](Settings& s, const Given& g) { s.report.views = g.file_name(); }},
    {"coco", 0, "FILE",
     "Write COCO annotations of all objects that are seen, as JSON, with masks of their hidden parts in additional "
     "fields.",
     Group::report, for_report, [](Settings& s, const Given& g) { s.report.coco = g.file_name(); }},
    {"coco-polygons", 0, "", "Write the masks of --coco as polygons instead of run lengths.", Group::report, for_report,
     [](Settings& s, const Given&) { s.report.coco_polygons = true; }},
    {"categories", 0, "FILE",
     "JSON file that gives each object its category, for --coco and --bop, in place of the categories of a scene file.",
     Group::report, for_report, [](Settings& s, const Given& g) { s.report.categories = g.file_name(); }},
    {"masks", 0, "FOLDER",
     "Write two PNG masks for every object in the picture, one of its visible part and one of the whole object. The "
     "folder is made if it does not exist.",
     Group::report, for_report, [](Settings& s, const Given& g) { s.report.masks = folder_name(g); }},
    {"bop", 0, "FOLDER",
     "Write a scene in the format of BOP, an image for each view: poses, masks, depth. A missing folder is made.",
     Group::report, for_report, [](Settings& s, const Given& g) { s.report.bop = folder_name(g); }},
    {"bop-visible", 0, "exact|bop19",
     "Visible samples of an object in --bop. exact, the default: those that show the object. bop19: those where it is "
     "at most 15 mm behind the visible surface, as in bop_toolkit.",
     Group::report, for_report, [](Settings& s, const Given& g) { s.report.bop_visible = g.choice<BopVisible>(); }},
    {"leave-out", 0, "NAME",
     "Leave objects with this name, or with a category of this name, out of --coco, --bop and --masks; they still hide "
     "other objects. May be given several times.",
     Group::report, for_report | may_repeat,
     [](Settings& s, const Given& g) { s.report.leave_out.push_back(g.string()); }},
    {"all-hiders", 0, "",
     "Also count, for --json, the samples of an object that each hider covers at any depth, and those that it alone "
     "covers.",
     Group::report, for_report, [](Settings& s, const Given&) { s.report.all_hiders = true; }},
    {"why", 0, "NAME", "Print only why the object with this name or number is seen or not.", Group::report, for_report,
     [](Settings& s, const Given& g) { s.report.why = g.string(); }},
};

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return result;
}

/// Returns suggestions for an unknown name: known names that contain it, or the nearest one.
std::string names_like(std::string_view wanted, const std::vector<std::string_view>& known) {
  constexpr std::size_t most_named = 5;
  std::vector<std::string> near;
  for (const std::string_view one : known) {
    const bool is_near = !wanted.empty() && lower(one).find(lower(wanted)) != std::string::npos;
    const std::string name = printable_name(one);
    if (is_near && near.size() < most_named && std::find(near.begin(), near.end(), name) == near.end())
      near.push_back(name);
  }
  if (const std::string_view nearest = nearest_word(wanted, known); near.empty() && !nearest.empty())
    near.push_back(printable_name(nearest));
  return near.empty() ? "" : fmt::format("did you mean {}?", fmt::join(near, ", "));
}

std::vector<std::string> outputs_of(const ReportSettings& report) {
  std::vector<std::string> files;
  for (const auto& file : {report.page, report.coco})
    if (file) files.push_back(*file);
  return files;
}

void check(const Settings& settings, const std::vector<std::string>& outputs) {
  check_view_settings(settings.view);
  const ReportSettings& report = settings.report;
  if (report.coco_polygons && !report.coco) throw UsageError("--coco-polygons needs --coco");
  if (report.bop_visible && !report.bop) throw UsageError("--bop-visible needs --bop");
  if (report.categories && !report.coco && !report.bop) throw UsageError("--categories needs --coco or --bop");
  if (!report.leave_out.empty() && !report.coco && !report.bop && !report.masks)
    throw UsageError("--leave-out needs --coco, --bop or --masks");
  if (settings.report.bop && settings.view.orthographic && !report.views)
    throw UsageError("--bop needs a perspective camera, because BOP has no other cameras");
  check_outputs(outputs, input_files(settings));
  if (report.page && *report.page != "-" && !report.page->ends_with(".html") && !report.page->ends_with(".htm"))
    throw UsageError(*report.page + ": the report is a page; use .html");
  if (settings.run.json && std::find(outputs.begin(), outputs.end(), "-") != outputs.end())
    throw UsageError("--json and the output '-' both write to standard output; give a file");
}

}  // namespace

std::span<const Option> report_option_table() { return report_options; }

std::span<const HiddenSamples> pairs_of(const std::vector<HiddenSamples>& all, std::uint32_t object) {
  const auto is_before = [](const HiddenSamples& pair, std::uint32_t number) { return pair.object < number; };
  const auto begin = std::lower_bound(all.begin(), all.end(), object, is_before);
  return {begin, std::lower_bound(begin, all.end(), object + 1, is_before)};
}

std::vector<std::uint32_t> objects_asked_for(const Settings& settings, const Scene& scene) {
  const std::optional<std::string>& wanted = settings.report.why;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
    if (!wanted || scene.instances[i].name == *wanted) numbers.push_back(i);
  if (!wanted || !numbers.empty()) return numbers;
  if (!hidden_asked_for(settings, scene).empty()) return {};
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
    if (std::to_string(i) == *wanted) return {i};
  std::vector<std::string_view> names;
  for (const Instance& instance : scene.instances) names.emplace_back(instance.name);
  complain_of_name(settings.model, "no object", *wanted, names);
}

void complain_of_name(const std::string& where, std::string_view what, std::string_view name,
                      const std::vector<std::string_view>& known) {
  std::string hint = names_like(name, known);
  if (hint.empty())
    hint = fmt::format("frontmost report lists {}",
                       known.size() == 1 ? "the one that it has" : fmt::format("all {}", known.size()));
  throw UsageError(fmt::format("{} has {} {}; {}", where, what, printable_name(name), hint));
}

std::vector<std::string> hidden_asked_for(const Settings& settings, const Scene& scene) {
  const std::optional<std::string>& wanted = settings.report.why;
  std::vector<std::string> names;
  for (const std::string& name : scene.source.hidden)
    if (!wanted || name == *wanted) names.push_back(name);
  return names;
}

std::vector<std::uint32_t> objects_by_sight(const Accounting& accounts) {
  std::vector<std::uint32_t> numbers(accounts.objects.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = std::uint32_t(i);
  std::stable_sort(numbers.begin(), numbers.end(), [&](std::uint32_t a, std::uint32_t b) {
    const ObjectAccount &one = accounts.objects[a], &other = accounts.objects[b];
    if (one.visible.count != other.visible.count) return one.visible.count > other.visible.count;
    return one.in_frame.count > other.in_frame.count;
  });
  return numbers;
}

int run_report(const Settings& settings) {
  const std::vector<std::string> outputs = outputs_of(settings.report);
  check(settings, outputs);
  if (settings.report.views) {
    if (settings.report.page) throw UsageError("--views excludes --output, because a page holds one view");
    report_views(settings, outputs);
    return exit_done;
  }
  DatasetFiles datasets(settings.report);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress, outputs);
  (void)objects_asked_for(settings, scene);
  datasets.begin(settings, scene);
  std::optional<Surfaces> surfaces(std::in_place, scene, execution);
  const View view = resolve_view(settings.view, *surfaces);
  show_framing_warning(settings, *surfaces, progress);
  const std::optional<Scene> cut = tessellated(scene, settings.view, view);
  if (cut) surfaces.emplace(*cut, execution);
  const Visible visible = zbuffer(*surfaces, view, execution);
  const Accounting accounts = account(
      *surfaces, visible, {.canvas = settings.report.canvas, .all_hiders = settings.report.all_hiders}, execution);
  const std::vector<Explanation> why = explain_all(*surfaces, visible, accounts, execution);
  const ObjectNames names(surfaces->scene());
  ReportRun run{settings, *surfaces, visible, accounts, why, names, {}};
  if (const auto& page = settings.report.page) {
    write_report_page(run, *page, execution);
    run.files.push_back(*page);
  }
  datasets.add(run, std::nullopt, execution);
  for (std::string& file : datasets.finish()) run.files.push_back(std::move(file));
  progress.clear();
  const bool stdout_is_taken = std::find(outputs.begin(), outputs.end(), "-") != outputs.end();
  if (!stdout_is_taken)
    print(settings.run.json ? dump(report_json(run)) : settings.report.why ? why_text(run) : report_text(run));
  return exit_done;
}

}  // namespace frontmost::cli
