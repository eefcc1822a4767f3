// SPDX-License-Identifier: Apache-2.0
// Folders are made before the model is read, so that failures are reported at once. Files are written last.
#include "cli/report/report_datasets.h"

#include <algorithm>

#include "cli/outputs.h"

namespace frontmost::cli {

DatasetFiles::DatasetFiles(const ReportSettings& settings) {
  options_.coco = settings.coco;
  options_.bop = settings.bop;
  options_.masks = settings.masks;
  options_.coco_polygons = settings.coco_polygons;
  options_.bop_visible = settings.bop_visible.value_or(BopVisible::exact);
  options_.are_masks_numbered = settings.views.has_value();
  options_.leave_out = settings.leave_out;
  if (settings.bop) bop_.emplace(*settings.bop);
  if (settings.masks) masks_.emplace(*settings.masks);
}

void DatasetFiles::begin(const Settings& settings, const Scene& scene) {
  if (!options_.coco && !options_.bop && !options_.masks) return;
  std::vector<std::string_view> names;
  for (const Instance& instance : scene.instances) names.emplace_back(instance.name);
  for (const Category& category : scene.categories) names.emplace_back(category.name);
  for (const std::string& name : options_.leave_out)
    if (std::find(names.begin(), names.end(), name) == names.end())
      complain_of_name("--leave-out: " + settings.model, "no object and no category", name, names);
  writing_.emplace();
  writer_.emplace(options_);
}

void DatasetFiles::add(const ReportRun& run, const std::optional<std::string>& name, const Execution& execution) {
  if (!writer_) return;
  const std::string picture = model_name(run.settings.model) + (name ? "_" + *name : "") + ".png";
  writer_->add({run.surfaces, run.visible, run.accounts}, picture, execution);
}

std::vector<std::string> DatasetFiles::finish() { return writer_ ? writer_->finish() : std::vector<std::string>(); }

}  // namespace frontmost::cli
