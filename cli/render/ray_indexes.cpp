// SPDX-License-Identifier: Apache-2.0
#include "cli/render/ray_indexes.h"

#include <frontmost/tessellate.h>

#include <algorithm>

#include "cli/render/output_writer.h"

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
                     [](const Material& m) { return m.alpha != Material::Alpha::opaque; });
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

}  // namespace frontmost::cli
