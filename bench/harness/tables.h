// SPDX-License-Identifier: Apache-2.0
// What is measured, one function a table.
#pragma once

#include "harness/options.h"
#include "harness/table.h"

namespace frontmost::bench {

/// Frontmost beside llvmpipe and Embree on the same views.
[[nodiscard]] Table measure_peers(const Options& options);

}  // namespace frontmost::bench
