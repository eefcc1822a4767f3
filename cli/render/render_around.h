// SPDX-License-Identifier: Apache-2.0
// Views through cameras that are no pinholes: panoramas and fisheyes, by rays.
#pragma once

#include "cli/render/render_view.h"

namespace frontmost::cli {

/// \throws UsageError for outputs that only a pinhole has.
void check_outputs_around(const Job& job);

/// As render_view(), for a job whose camera is no pinhole. Precondition: the context has an index.
[[nodiscard]] ViewResult render_around(const Job& job, const RenderContext& context);

}  // namespace frontmost::cli
