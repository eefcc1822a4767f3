// SPDX-License-Identifier: Apache-2.0
// The report as files of data sets: COCO's annotations, and a scene folder of BOP.
#pragma once

#include "cli/report/report_run.h"

namespace frontmost::cli {

/// Annotations of the picture: of every object that is seen its visible mask, and beside what COCO has, all of it that
/// lies within the picture.
[[nodiscard]] Json coco_json(const ReportRun& run, bool with_polygons, const Execution& execution);

/// A scene folder of BOP with one image and the objects that cover a sample of it: all of its files, or none.
/// \returns their paths. Precondition: the view is perspective, and the folder is there.
/// \throws Error file_unwritable; unsupported for objects that are stretched or mirrored.
std::vector<std::string> write_bop_scene(const ReportRun& run, const std::string& folder, const Execution& execution);

}  // namespace frontmost::cli
