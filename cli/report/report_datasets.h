// SPDX-License-Identifier: Apache-2.0
// The report as files of data sets: COCO's annotations, a scene folder of BOP, and masks.
#pragma once

#include <frontmost/base.h>
#include <frontmost/report.h>

#include <optional>
#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/report/report_run.h"

namespace frontmost::cli {

/// The files of --coco, --bop and --masks, of one view or of several. Without these options it does nothing.
class DatasetFiles {
 public:
  /// Makes the folders. \throws Error file_unwritable.
  explicit DatasetFiles(const ReportSettings& settings);

  /// From here to finish() an interruption waits until unfinished files are gone.
  /// \throws UsageError where --leave-out names nothing of the scene.
  void begin(const Settings& settings, const Scene& scene);
  /// The next view; `name` is what {view} stands for, where there are several.
  void add(const ReportRun& run, const std::optional<std::string>& name, const Execution& execution);
  /// \returns the paths of all files.
  [[nodiscard]] std::vector<std::string> finish();

 private:
  DatasetOptions options_;
  std::optional<MadeFolder> bop_, masks_;
  std::optional<WritingFiles> writing_;
  std::optional<DatasetWriter> writer_;
};

}  // namespace frontmost::cli
