// SPDX-License-Identifier: Apache-2.0
#include "cli/render/render_curved.h"

#include <frontmost/shade.h>
#include <frontmost/tessellate.h>

#include <algorithm>

#include "cli/inputs.h"
#include "cli/render/output_writer.h"
#include "cli/stopwatch.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

bool is_pinhole(const Job& job) { return job.view.camera_model == CameraModel::pinhole; }

bool has_ray_shadows(const Job& job) {
  return job.output.shading == Shading::lit && job.output.shadows == Shadows::rays;
}

/// True where layers are looked for, or something of the model lets light through.
bool sees_through(const Job& job, const Scene& scene) {
  return job.output.opacity < 1 || !job.layer_files.empty() || wants(job, OutputKind::deep) ||
         std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.alpha != Material::Alpha::opaque || m.is_see_through(); });
}

CurvedVisible timed_cast(const CurvedIndex& index, const View& view, const RenderContext& context,
                         std::vector<double>& times) {
  for (int i = 1;; ++i) {
    const Stopwatch watch;
    CurvedVisible seen = raycast(index, view, context.execution);
    times.push_back(watch.milliseconds());
    if (i >= context.run.repeat) return seen;
  }
}

std::vector<CurvedVisible> cast(const CurvedIndex& index, const std::vector<View>& views, const RenderContext& context,
                                ViewResult& result) {
  std::vector<CurvedVisible> seen;
  seen.push_back(timed_cast(index, views.front(), context, result.timings.visible));
  if (views.size() > 1) {
    std::vector<double> times;
    seen.push_back(timed_cast(index, views.back(), context, times));
    result.timings.visible_maps = times.front();
  }
  return seen;
}

/// What the key light sees of the surfaces themselves.
std::optional<Visible> seen_by_light(const Job& job, const RenderContext& context, const CurvedIndex& index,
                                     const Visible& picture) {
  if (!has_key_light(job) || job.output.shadows == Shadows::off) return std::nullopt;
  const std::optional<View> light =
      key_light_view(picture, context.surfaces.bounds(), shade_options(job, context).light, context.execution);
  if (!light) return std::nullopt;
  return raycast(index, *light, context.execution).visible;
}

}  // namespace

void plan_curved(const Scene& scene, const RunSettings& run, std::vector<Job>& jobs) {
  constexpr double kError = 0.1;  // pixels; as good as exact to the eye
  const bool is_curved = has_curved(scene);
  for (Job& job : jobs) {
    if (!is_curved || !is_pinhole(job)) {
      job.view.tessellation_error.reset();
    } else if (run.method == Method::raycast && !job.view.tessellation_error &&
               (sees_through(job, scene) || has_ray_shadows(job))) {
      job.view.tessellation_error = kError;
    }
  }
}

bool meets_curved(const Job& job, const RunSettings& run, const Scene& scene) {
  return (run.method == Method::raycast || !is_pinhole(job)) && !job.view.tessellation_error && has_curved(scene);
}

bool needs_index(const Job& job, const RunSettings& run) {
  return run.method == Method::raycast || !is_pinhole(job) || has_ray_shadows(job);
}

RayIndexes::RayIndexes(std::span<const Job> jobs, const RunSettings& run, const Surfaces& surfaces,
                       const Execution& execution) {
  for (const Job& job : jobs) {
    if (meets_curved(job, run, surfaces.scene())) {
      if (!curved) curved.emplace(surfaces.scene(), execution);
    } else if (!triangles && !job.view.tessellation_error && needs_index(job, run)) {
      triangles.emplace(surfaces, execution);
    }
  }
}

ViewResult render_curved_view(const Job& job, const RenderContext& context) {
  const CurvedIndex& index = *context.curved;
  ViewResult result;
  result.name = job.name;
  result.view = resolve_view(job.view, context.surfaces);
  result.target = focal_point_of(job.view, result.view, context.surfaces);
  const SightPlan plan = plan_sights(job, context.run, context.keep_picture, result.view);
  const std::vector<View> views = views_of(result.view, plan);
  const std::vector<CurvedVisible> seen = cast(index, views, context, result);
  const Stopwatch watch;
  const Facets shown = facets_of(index, context.surfaces.scene(), seen);
  const Surfaces surfaces(shown.scene, context.execution);

  Sights sights;
  sights.shared = plan.shared;
  std::optional<Visible> light;
  if (plan.picture_samples) {
    sights.picture = SeenView{shown.visible.front(), {}};
    light = seen_by_light(job, context, index, sights.picture->visible);
  }
  if (plan.maps && !plan.shared) sights.maps = SeenView{shown.visible.back(), {}};
  sights.stream_ids = &shown.elements;
  if (light) sights.seen_by_light = &*light;
  result.timings.shade = watch.milliseconds();
  Shader shader(surfaces);
  finish_view(job, {surfaces, shader, context.environments, context.run, context.execution, context.keep_picture},
              sights, result);
  return result;
}

ViewResult render_tessellated_view(const Job& job, const RenderContext& context) {
  const View view = resolve_view(job.view, context.surfaces);
  const std::optional<Scene> scene = tessellated(context.surfaces.scene(), job.view, view);
  const Surfaces surfaces(*scene, context.execution);
  std::optional<RayIndex> index;
  if (needs_index(job, context.run)) index.emplace(surfaces, context.execution);
  Shader shader(surfaces);
  return render_view(job, {surfaces, shader, context.environments, context.run, context.execution, context.keep_picture,
                           index ? &*index : nullptr, context.by_rays, nullptr, &context.surfaces});
}

}  // namespace frontmost::cli
