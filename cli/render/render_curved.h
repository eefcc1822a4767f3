// SPDX-License-Identifier: Apache-2.0
// Models with spheres and patches: which views meet the curved surfaces themselves, which draw triangles made for them,
// and the indexes that the rays of either need.
#pragma once

#include <frontmost/curved.h>

#include <optional>
#include <span>
#include <vector>

#include "cli/render/jobs.h"
#include "cli/render/render_view.h"

namespace frontmost::cli {

/// Says how curved models are drawn, by the jobs' tessellation errors: rays meet the surfaces themselves unless
/// triangles are asked for, or needed: what is seen through something is looked for among triangles. Cameras that are
/// no pinholes have no screen to measure an error on, and see nothing through anything.
void plan_curved(const Scene& scene, const RunSettings& run, std::vector<Job>& jobs);

/// True where the pixels' rays meet curved surfaces themselves. After plan_curved().
[[nodiscard]] bool meets_curved(const Job& job, const RunSettings& run, const Scene& scene);

/// True where a view of triangles has rays: by the method, by the camera or for its shadows.
[[nodiscard]] bool needs_index(const Job& job, const RunSettings& run);

/// Those that the jobs need, but for views that cut triangles of their own. After plan_curved().
struct RayIndexes {
  std::optional<RayIndex> triangles;
  std::optional<CurvedIndex> curved;

  RayIndexes(std::span<const Job> jobs, const RunSettings& run, const Surfaces& surfaces, const Execution& execution);
};

/// Like render_view(), but every ray meets the curved surfaces themselves. Precondition: a pinhole camera, nothing that
/// is seen through, and an index in `context.curved`.
/// `context.surfaces` are those of the model's triangles; camera and object names go by them.
[[nodiscard]] ViewResult render_curved_view(const Job& job, const RenderContext& context);

/// Like render_view(), on triangles that are made for the view. Precondition: the model is curved, the job says how
/// finely to cut it, and has a pinhole camera.
[[nodiscard]] ViewResult render_tessellated_view(const Job& job, const RenderContext& context);

}  // namespace frontmost::cli
