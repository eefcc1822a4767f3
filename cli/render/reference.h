// SPDX-License-Identifier: Apache-2.0
// Comparing a picture with a reference.
#pragma once

#include "cli/render/render_view.h"

namespace frontmost::cli {

/// Writes the difference picture where they differ by more than the threshold; that is not an error here.
/// \throws Error when the reference cannot be read, or has another size
[[nodiscard]] ReferenceResult compare_with_reference(const Image& picture, const Job& job, const Execution& execution);

}  // namespace frontmost::cli
