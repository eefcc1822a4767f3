// SPDX-License-Identifier: Apache-2.0
// The report as files of data sets: COCO's annotations, a scene folder of BOP, and masks.
#pragma once

#include <functional>

#include "cli/report/report_run.h"
#include "cli/staged_folder.h"

namespace frontmost::cli {

/// Annotations of the picture: of every object that is seen its visible mask, and beside what COCO has, all of it that
/// lies within the picture.
[[nodiscard]] Json coco_json(const ReportRun& run, bool with_polygons, const Execution& execution);

/// A scene folder of BOP with one image and the objects that cover a sample of it: all of its files, or none.
/// \returns their paths. Precondition: the view is perspective, and the folder is there.
/// \throws Error file_unwritable; unsupported for objects that are stretched or mirrored.
std::vector<std::string> write_bop_scene(const ReportRun& run, const std::string& folder, const Execution& execution);

/// Masks of the objects that cover a sample of the picture, two pictures each: all of them, or none.
/// \returns their paths. Precondition: the folder is there. \throws Error file_unwritable.
std::vector<std::string> write_masks(const ReportRun& run, const std::string& folder, const Execution& execution);

// Their parts.

/// As large as the picture, white where a pixel is in the part and black elsewhere.
[[nodiscard]] Image mask_image(const PixelMask& mask, MaskPart part, const View& view);
/// Lets `write` make files in a hidden folder, which has the folders `within`, and moves those that it names when all
/// are whole. Masks of an earlier report beside them go. \returns their paths. \throws Error file_unwritable, and what
/// `write` throws, told of the folder itself.
std::vector<std::string> write_folder(const std::string& folder, std::initializer_list<const char*> within,
                                      const std::function<std::vector<std::string>(const StagedFolder&)>& write);

}  // namespace frontmost::cli
