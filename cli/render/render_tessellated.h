// SPDX-License-Identifier: Apache-2.0
// Models with spheres and patches, as triangles that are made for each view.
#pragma once

#include "cli/render/jobs.h"
#include "cli/render/render_view.h"

namespace frontmost::cli {

/// Whether a view has triangles of its own: the model is curved, the job says how finely to cut it, and its camera is a
/// pinhole. Others have no screen to measure an error on.
[[nodiscard]] bool is_tessellated(const Job& job, const Scene& scene);

/// True where a view has rays: by the method, by the camera or for its shadows.
[[nodiscard]] bool needs_index(const Job& job, const RunSettings& run);

/// As render_view(). Precondition: is_tessellated().
[[nodiscard]] ViewResult render_tessellated_view(const Job& job, const RenderContext& context);

}  // namespace frontmost::cli
