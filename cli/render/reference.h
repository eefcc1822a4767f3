// SPDX-License-Identifier: Apache-2.0
// Comparing a picture with a reference.
#pragma once

#include "cli/render/render_view.h"

namespace frontmost::cli {

/// Reads every job's reference, so that one that cannot be read is told before anything is drawn or written. Those of
/// a long batch together may be more than memory holds: what goes beyond 2^26 pixels is let go, and read once more.
/// \throws Error when one cannot be read.
void read_references(std::vector<Job>& jobs);

/// For a picture that is not written yet: writes the difference picture where they differ by more than the threshold;
/// that is not an error here. \throws Error when the reference cannot be read, or has another size or other channels
[[nodiscard]] ReferenceResult compare_with_reference(const Image& picture, const Job& job, const Execution& execution);

}  // namespace frontmost::cli
