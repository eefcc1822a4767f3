// SPDX-License-Identifier: Apache-2.0
// Tables of the A-buffer, one function each, and the translucent scenes that they measure.
#pragma once

#include "harness/program.h"
#include "harness/stage.h"
#include "harness/table.h"

namespace frontmost::bench {

/// The requested numbers of sub-samples along a pixel's side.
[[nodiscard]] inline std::vector<int> grids(const Options& options) {
  return options.grid < 0 ? std::vector<int>{0, 4, 8} : std::vector<int>{options.grid};
}
[[nodiscard]] inline int samples_of(int grid) { return grid == 0 ? 1 : grid * grid; }

/// A scene of translucent_entries(). Each triangle's colour comes from one light at the camera's upper left and is
/// computed once for all pictures.
[[nodiscard]] Stage make_lit(std::string_view scene_name, const std::string& models);

/// `count` sheets that fill the picture, one behind the other.
[[nodiscard]] Stage make_sheets(int count, int width, int height);

/// Finds what is visible and shades all layers in their own colours, at the opacity in `options`.
[[nodiscard]] Image draw_layers(const Stage& stage, const AbufferOptions& options, const Execution& execution);

/// Opacity of the translucent copies, here and in depth peeling.
inline constexpr float opacity_of_copies = 0.4f;

/// Translucent copies of a model beside depth peeling. The table fails if the two pictures differ.
[[nodiscard]] Table measure_peeling(const Options& options);
/// Time on one thread and on all.
[[nodiscard]] Table measure_abuffer_threads(const Options& options);
/// Time by every instruction set of this machine.
[[nodiscard]] Table measure_abuffer_isas(const Options& options);
/// Time by the number of sheets that fill the picture.
[[nodiscard]] Table measure_layers(const Options& options);
/// Memory beyond the picture itself. The table fails if the promised limit is exceeded.
[[nodiscard]] Table measure_abuffer_memory(const Options& options);

}  // namespace frontmost::bench
