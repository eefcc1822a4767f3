// SPDX-License-Identifier: Apache-2.0
// Views of models with spheres and patches.
#pragma once

#include <frontmost/curved.h>

#include "cli/render/render_view.h"

namespace frontmost::cli {

/// Like render_view(), but every ray meets the curved surfaces themselves. Precondition: a pinhole camera, nothing that
/// is seen through, and an index in `context.curved`.
/// `context.surfaces` are those of the model's triangles; camera and object names go by them.
[[nodiscard]] ViewResult render_curved_view(const Job& job, const RenderContext& context);

/// Like render_view(), on triangles that are made for the view. Precondition: the model is curved, the job says how
/// finely to cut it, and has a pinhole camera.
[[nodiscard]] ViewResult render_tessellated_view(const Job& job, const RenderContext& context);

}  // namespace frontmost::cli
