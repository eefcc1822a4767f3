// SPDX-License-Identifier: Apache-2.0
// Models with spheres and patches, tessellated for each view.
#pragma once

#include "cli/render/jobs.h"
#include "cli/render/render_view.h"

namespace frontmost::cli {

/// Whether a view has its own triangles: the model is curved, the job states the allowed error, and the camera is a
/// pinhole. Other cameras have no screen to measure the error on.
[[nodiscard]] bool is_tessellated(const Job& job, const Scene& scene);

/// Whether a view needs rays: for the method, the camera or shadows.
[[nodiscard]] bool needs_index(const Job& job, const RunSettings& run);

/// Does what render_view() does, with triangles made for the view. Precondition: is_tessellated().
[[nodiscard]] ViewResult render_tessellated_view(const Job& job, const RenderContext& context);

}  // namespace frontmost::cli
