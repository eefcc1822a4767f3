// SPDX-License-Identifier: Apache-2.0
// Reports of many views in one process. The model is prepared once, and each report is printed before the next one is
// made.
#include <fmt/format.h>
#include <frontmost/scene.h>
#include <frontmost/version.h>
#include <frontmost/zbuffer.h>

#include <map>

#include "cli/console.h"
#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/render/jobs.h"
#include "cli/report/report_datasets.h"
#include "cli/report/report_run.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

void check_view_of_report(const ViewSettings& view, const ReportSettings& report) {
  check_view_settings(view);
  if (report.bop && view.orthographic)
    throw UsageError("--bop needs a perspective camera, because BOP has no other cameras");
  if (view.camera_model != CameraModel::pinhole)
    throw UsageError("the command report needs a pinhole camera; --camera-model must be left out");
  if (view.depth.is_used)
    throw UsageError("the command report counts the nearest surfaces; leave out the options of a depth buffer");
}

/// Returns the views of the file, checked before the model is read.
std::vector<ViewSettings> views_of_file(const Settings& settings) {
  std::vector<ViewSettings> views;
  std::map<std::string, std::size_t> numbers;  // by name of the view
  for (Settings& one : read_batch(*settings.report.views, settings)) {
    try {
      check_view_of_report(one.view, settings.report);
      const auto [known, is_new] = numbers.emplace(view_name(one.view), views.size());
      if (settings.report.coco && !is_new)
        throw UsageError(fmt::format(
            "has the name {}, like views[{}], but --coco needs a picture for each view: give it another name",
            printable_name(known->first), known->second));
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: views[{}]: {}", *settings.report.views, views.size(), error.what()));
    }
    views.push_back(std::move(one.view));
  }
  return views;
}

/// Accounts for one view after the other, in the same memory.
class ViewReporter {
 public:
  ViewReporter(const Settings& settings, const Scene& scene, const Execution& execution)
      : settings_(settings), scene_(scene), execution_(execution), surfaces_(scene, execution), names_(scene) {}

  /// Calls tell(run) with the results of a view.
  template <class Tell>
  void report(const ViewSettings& settings, const Tell& tell) {
    const View view = resolve_view(settings, surfaces_);
    const std::optional<Scene> cut = tessellated(scene_, settings, view);
    std::optional<Surfaces> own;
    if (cut) own.emplace(*cut, execution_);
    const Surfaces& surfaces = own ? *own : surfaces_;
    const Visible& visible = zbuffer_.draw(surfaces, view, execution_);
    const Accounting accounts = account(
        surfaces, visible, {.canvas = settings_.report.canvas, .all_hiders = settings_.report.all_hiders}, execution_);
    const std::vector<Explanation> why = explain_all(surfaces, visible, accounts, execution_);
    tell(ReportRun{settings_, surfaces, visible, accounts, why, names_, {}});
  }

 private:
  const Settings& settings_;
  const Scene& scene_;
  const Execution& execution_;
  Surfaces surfaces_;
  ObjectNames names_;
  ZBuffer zbuffer_;
};

}  // namespace

void report_views(const Settings& settings, const std::vector<std::string>& outputs) {
  const std::vector<ViewSettings> views = views_of_file(settings);
  DatasetFiles datasets(settings.report);
  Progress progress(settings.run.quiet);
  const Execution execution = execution_for(settings.run, progress);
  const Scene scene = load_model(settings, execution, progress, outputs);
  (void)objects_asked_for(settings, scene);
  datasets.begin(settings, scene);
  const bool is_stdout_taken = settings.report.coco == "-";
  ViewReporter reporter(settings, scene, execution);
  std::optional<JsonListPrinter> list;
  if (settings.run.json) list.emplace(Json{{"frontmost", FRONTMOST_VERSION}, {"model", settings.model}}, "views");
  for (std::size_t i = 0; i < views.size(); ++i) {
    progress.set_prefix(fmt::format("view {} of {}: ", i + 1, views.size()));
    reporter.report(views[i], [&](const ReportRun& run) {
      const std::string name = view_name(views[i]);
      datasets.add(run, name, execution);
      progress.clear();
      if (list) {
        Json json = {{"name", name}};
        json.update(view_report_json(run));
        list->add(json);
      } else if (!is_stdout_taken) {
        print(printable_name(name) + ":\n" + (settings.report.why ? why_text(run) : report_text(run)) + '\n');
      }
    });
    stop_if_interrupted();
  }
  const std::vector<std::string> files = datasets.finish();
  if (list) list->finish({{"files", files}});
}

}  // namespace frontmost::cli
