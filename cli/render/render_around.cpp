// SPDX-License-Identifier: Apache-2.0
// Panoramas and fisheyes have rays instead of a view, and ranges instead of depths. The other steps are those of a
// pinhole. Of the maps, these cameras support some, with one ray per pixel.
#include <fmt/format.h>
#include <frontmost/pictures.h>
#include <frontmost/raycast.h>

#include <algorithm>

#include "cli/failure.h"
#include "cli/render/blank.h"
#include "cli/render/output_writer.h"
#include "cli/render/render_view.h"
#include "cli/stopwatch.h"
#include "cli/view/sight.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

constexpr double half_turn_degrees = 180;
constexpr glm::ivec2 panorama_resolution{2048, 1024}, fisheye_resolution{1024, 1024};

/// Returns the camera, with the pose that a pinhole with the same options has.
RayCamera camera_of(const ViewResult& result, int samples) {
  const View& view = result.view;
  if (result.camera_model == CameraModel::panorama)
    return {Panorama{view.width, view.height}, view.world_from_eye, samples};
  return {Fisheye{view.width, view.height, glm::radians(result.fisheye_angle)}, view.world_from_eye, samples};
}

ViewResult resolve(const Job& job, const Surfaces& surfaces) {
  ViewSettings settings = job.view;
  const bool is_panorama = settings.camera_model == CameraModel::panorama;
  if (!settings.resolution) settings.resolution = is_panorama ? panorama_resolution : fisheye_resolution;
  ViewResult result;
  result.name = job.name;
  result.view = resolve_view(settings, surfaces);
  result.target = focal_point_of(settings, result.view, surfaces);
  result.camera_model = settings.camera_model;
  result.fisheye_angle = settings.fisheye_angle.value_or(half_turn_degrees);
  return result;
}

RangeScan timed_scan(const RayScene& rays, const RayCamera& camera, const RenderContext& context,
                     std::vector<double>& times) {
  for (int i = 1;; ++i) {
    const Stopwatch watch;
    RangeScan result = rays.scan(camera, context.execution);
    times.push_back(watch.milliseconds());
    if (i >= context.run.repeat) return result;
  }
}

Image ranges(const RangeScan& around, const char* name, float background) {
  Buffer<float> values = around.ranges;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (around.primitives[i] == no_primitive) values[i] = background;
  Image image{around.width, around.height, {}};
  image.channels.push_back({name, std::move(values)});
  return image;
}

Image map_around(OutputKind kind, const Job& job, const RayScene& rays, const RangeScan& around) {
  const float background = job.output.background_depth;
  switch (kind) {
    // Depth is a range here, because there is no image plane.
    case OutputKind::depth: return ranges(around, "Z", background);
    case OutputKind::ray_distance: return ranges(around, "distance", background);
    case OutputKind::primitive_ids: return rays.ids(around, IdKind::primitive);
    case OutputKind::object_ids: return rays.ids(around, IdKind::object);
    case OutputKind::material_ids: return rays.ids(around, IdKind::material);
    case OutputKind::picture:
    case OutputKind::deep:
    case OutputKind::window_depth:
    case OutputKind::normals: break;  // refused earlier, or no map
  }
  return {};
}

Seen summary_around(const RayScene& rays, const RangeScan& around) {
  Seen seen;
  Image both = rays.ids(around, IdKind::primitive);
  both.channels.push_back({"distance", around.ranges});
  seen.hash = content_hash(both);
  count_objects(rays.surfaces, rays.ids(around, IdKind::object), seen);
  return seen;
}

/// Hits of a job's rays: those of the picture, and one at each pixel's centre. One scan serves both if the rays are the
/// same.
struct SightsAround {
  std::optional<RangeScan> picture, middles;

  [[nodiscard]] const RangeScan& for_picture() const { return picture ? *picture : *middles; }
  [[nodiscard]] const RangeScan& for_maps() const { return middles ? *middles : *picture; }
};

SightsAround look_around(const Job& job, const RayScene& rays, const RenderContext& context, ViewResult& result) {
  const SightPlan plan = plan_sights(job, context.run, context.keep_picture, result.view);
  SightsAround sights;
  std::vector<double>& times = result.timings.visible;
  if (plan.picture_samples > 1)
    sights.picture = timed_scan(rays, camera_of(result, *plan.picture_samples), context, times);
  if (sights.picture && !plan.maps) return sights;
  std::vector<double> map_times;
  sights.middles = timed_scan(rays, camera_of(result, 1), context, sights.picture ? map_times : times);
  if (sights.picture) result.timings.visible_maps = map_times.front();
  return sights;
}

bool is_blank(const RangeScan& around) {
  return std::all_of(around.primitives.begin(), around.primitives.end(),
                     [](PrimitiveId id) { return id == no_primitive; });
}

Image shade_around(const Job& job, const RangeScan& met, const RenderContext& context) {
  (void)context.shader.shade(ScanInput{&met, context.index}, shade_options(job, context), context.execution);
  return context.shader.take();
}

}  // namespace

void check_outputs_around(const Job& job) {
  if (job.view.camera_model == CameraModel::pinhole) return;
  if (wants(job, OutputKind::normals)) throw UsageError("--camera-model and --normals exclude each other");
  if (!job.layer_files.empty() || wants(job, OutputKind::deep))
    throw UsageError("--camera-model excludes --layers and --deep");
  if (job.output.ambient_occlusion > 0) throw UsageError("--camera-model and --ambient-occlusion exclude each other");
  if (job.output.blend != Blend::linear) throw UsageError("--camera-model and --blend srgb exclude each other");
  if (job.output.light.options.shows_environment)
    throw UsageError("--camera-model and --show-environment exclude each other");
}

ViewResult render_around(const Job& job, const RenderContext& context) {
  ViewResult result = resolve(job, context.surfaces);
  const RayScene rays{context.surfaces, *context.index};
  const SightsAround sights = look_around(job, rays, context, result);
  const RangeScan& around = sights.for_maps();
  if (job.output.hash || context.run.json) result.seen = summary_around(rays, around);
  if (is_blank(around)) result.warnings.emplace_back("nothing is in view: no ray meets the model");
  std::optional<Image> picture;
  if (wants(job, OutputKind::picture) || context.keep_picture || job.output.reference) {
    const Stopwatch watch;
    picture = shade_around(job, sights.for_picture(), context);
    result.timings.shade = watch.milliseconds();
    const std::span<const PrimitiveId> first(around.primitives.data(), around.index(0, around.height));
    if (job.output.background && nothing_stands_out(*picture, first, *job.output.background))
      result.warnings.push_back(contrast_warning(false));
  }
  const auto map = [&](OutputKind kind) { return map_around(kind, job, rays, around); };
  if (job.output.reference) result.reference = compare_with_reference(*picture, job, context.execution);
  write_files({job, context.execution, map, picture ? &*picture : nullptr}, result);
  if (context.keep_picture) result.picture = std::move(picture);
  return result;
}

}  // namespace frontmost::cli
