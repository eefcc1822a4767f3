// SPDX-License-Identifier: Apache-2.0
// What is measured, one function a table.
#pragma once

#include "harness/options.h"
#include "harness/table.h"

namespace frontmost::bench {

/// Hidden lines with and without intersections, and on all threads.
[[nodiscard]] Table measure_lines(const Options& options);
/// The painter's order beside the z-buffer, and what a figure takes beyond it. Fails where painting the order gives
/// another picture than the z-buffer without a reason.
[[nodiscard]] Table measure_painter(const Options& options);
/// Hatching and dots, with and without shadows, and on all threads.
[[nodiscard]] Table measure_tones(const Options& options);

}  // namespace frontmost::bench
