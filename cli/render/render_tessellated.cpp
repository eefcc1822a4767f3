// SPDX-License-Identifier: Apache-2.0
#include "cli/render/render_tessellated.h"

#include <frontmost/view.h>

#include "cli/inputs.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

bool is_pinhole(const Job& job) { return job.view.camera_model == CameraModel::pinhole; }

}  // namespace

bool is_tessellated(const Job& job, const Scene& scene) {
  return job.view.tessellation_error && is_pinhole(job) && has_curved(scene);
}

bool needs_index(const Job& job, const RunSettings& run) {
  return run.method == Method::raycast || !is_pinhole(job) ||
         (job.output.shading == Shading::lit && job.output.shadows == Shadows::rays);
}

ViewResult render_tessellated_view(const Job& job, const RenderContext& context) {
  const View view = resolve_view(job.view, context.surfaces);
  const std::optional<Scene> scene = tessellated(context.surfaces.scene(), job.view, view);
  const Surfaces surfaces(*scene, context.execution);
  std::optional<RayIndex> index;
  if (needs_index(job, context.run)) index.emplace(surfaces, context.execution);
  Shader shader(surfaces);
  LineDrawer line_drawer(surfaces);
  return render_view(job, {surfaces, shader, context.environments, context.run, context.execution, context.keep_picture,
                           index ? &*index : nullptr, context.by_rays, &context.surfaces, nullptr, &line_drawer});
}

}  // namespace frontmost::cli
