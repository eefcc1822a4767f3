// SPDX-License-Identifier: Apache-2.0
// The report as data sets: COCO annotations, a scene folder of BOP, and masks.
#pragma once

#include <frontmost/base.h>
#include <frontmost/report.h>

#include <optional>
#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/report/report_run.h"

namespace frontmost::cli {

/// The files of --coco, --bop and --masks, for one view or several. Does nothing without these options.
class DatasetFiles {
 public:
  /// Makes the folders. \throws Error file_unwritable.
  explicit DatasetFiles(const ReportSettings& settings);

  /// Starts writing. Until finish(), an interruption waits for the removal of unfinished files. \throws UsageError if
  /// --leave-out names nothing in the scene.
  void begin(const Settings& settings, const Scene& scene);
  /// Adds the next view. `name` is the text for {view}, if there are several.
  void add(const ReportRun& run, const std::optional<std::string>& name, const Execution& execution);
  /// Ends writing. \returns the paths of all files.
  [[nodiscard]] std::vector<std::string> finish();

 private:
  DatasetOptions options_;
  std::optional<MadeFolder> bop_, masks_;
  std::optional<WritingFiles> writing_;
  std::optional<DatasetWriter> writer_;
};

}  // namespace frontmost::cli
