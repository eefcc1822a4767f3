// SPDX-License-Identifier: Apache-2.0
// What is measured of the A-buffer, one function a table, and the translucent scenes that it is measured on.
#pragma once

#include "harness/program.h"
#include "harness/stage.h"
#include "harness/table.h"

namespace frontmost::bench {

/// Sub-samples along a pixel's side, those that are asked for.
[[nodiscard]] inline std::vector<int> grids(const Options& options) {
  return options.grid < 0 ? std::vector<int>{0, 4, 8} : std::vector<int>{options.grid};
}
[[nodiscard]] inline int samples_of(int grid) { return grid == 0 ? 1 : grid * grid; }

/// One of translucent_entries(). Every triangle has the colour that one light at the camera's upper left gives it, once
/// for all pictures.
[[nodiscard]] Stage make_lit(std::string_view scene_name, const std::string& models);

/// `count` sheets that fill the picture, one behind the other.
[[nodiscard]] Stage make_sheets(int count, int width, int height);

/// What is visible, and the picture of all layers in their own colours, everything with this opacity.
[[nodiscard]] Image draw_layers(const Stage& stage, const AbufferOptions& options, const Execution& execution);

/// Of translucent copies, here and in depth peeling.
inline constexpr float opacity_of_copies = 0.4f;

/// Translucent copies of a model beside depth peeling. Fails where the two pictures are not the same.
[[nodiscard]] Table measure_peeling(const Options& options);
/// One thread and all of them.
[[nodiscard]] Table measure_abuffer_threads(const Options& options);
/// Every instruction set of this machine.
[[nodiscard]] Table measure_abuffer_isas(const Options& options);
/// Sheets that fill the picture: time by their number.
[[nodiscard]] Table measure_layers(const Options& options);
/// Memory beside the picture. Fails where the promise is broken.
[[nodiscard]] Table measure_abuffer_memory(const Options& options);

}  // namespace frontmost::bench
