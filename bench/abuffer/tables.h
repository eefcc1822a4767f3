// SPDX-License-Identifier: Apache-2.0
// What is measured, one function a table.
#pragma once

#include "harness/options.h"
#include "harness/table.h"

namespace frontmost::bench {

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
