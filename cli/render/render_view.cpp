// SPDX-License-Identifier: Apache-2.0
// Renders one view. The picture has several samples per pixel. Maps, the report and the hash have one, at pixel
// centres, so that they do not depend on the picture's antialiasing.
#include "cli/render/render_view.h"

#include <fmt/format.h>
#include <frontmost/abuffer.h>
#include <frontmost/pictures.h>

#include <algorithm>

#include "cli/render/blank.h"
#include "cli/render/edges.h"
#include "cli/render/output_writer.h"
#include "cli/stopwatch.h"
#include "cli/view/sight.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

bool wants_picture(const Job& job, bool keep_picture) {
  return wants(job, OutputKind::picture) || keep_picture || job.output.reference;
}

bool is_map(OutputKind kind) { return kind != OutputKind::picture && kind != OutputKind::deep; }

bool wants_maps(const Job& job) {
  return std::any_of(job.files.begin(), job.files.end(),
                     [](const FileToWrite& file) { return std::any_of(file.kinds.begin(), file.kinds.end(), is_map); });
}

SeenView look_once(const View& view, const DepthSettings& depth, const RenderContext& context, ZBuffer* buffer) {
  if (context.run.method == Method::abuffer)
    return {visible_layers(context.surfaces, view, 1, {}, context.execution).front(), {}};
  const RayIndex* index = context.by_rays ? context.index : nullptr;
  if (buffer && !index && !depth.is_used) {
    buffer->draw(context.surfaces, view, context.execution);
    return {buffer->take(), {}};
  }
  return look_at_surfaces(context.surfaces, view, depth, context.execution, index);
}

SeenView timed(const View& view, const DepthSettings& depth, const RenderContext& context, ZBuffer* buffer,
               std::vector<double>& times) {
  for (int i = 1;; ++i) {
    const Stopwatch watch;
    SeenView sight = look_once(view, depth, context, buffer);
    times.push_back(watch.milliseconds());
    if (i >= context.run.repeat) return sight;
    if (buffer) buffer->give_back(std::move(sight.visible));
  }
}

/// Whether the z-buffer draws once, only for a picture in bytes with several samples.
bool needs_only_pixels(const Job& job, const RenderContext& context, const SightPlan& plan) {
  const bool is_bitmap = wants(job, OutputKind::picture) && !context.keep_picture && needs_only_bitmap(job);
  const bool is_zbuffer = context.run.method.value_or(Method::zbuffer) == Method::zbuffer && !job.view.depth.is_used;
  return is_bitmap && is_zbuffer && !context.buffers && context.run.repeat == 1 && plan.picture_samples > 1 &&
         !wants(job, OutputKind::deep) && job.output.shading != Shading::depth;
}

Sights look(const Job& job, const RenderContext& context, ViewResult& result) {
  const SightPlan plan = plan_sights(job, context.run, context.keep_picture, result.view);
  View view = result.view;
  Sights sights;
  sights.shared = plan.shared;
  if (plan.picture_samples) view.samples = *plan.picture_samples;
  if (needs_only_pixels(job, context, plan)) {
    const Stopwatch watch;
    sights.pixels = zbuffer_pixels(context.surfaces, view, context.execution);
    result.timings.visible.push_back(watch.milliseconds());
  } else if (plan.picture_samples) {
    ZBuffer* const buffer = context.buffers ? &context.buffers->picture : nullptr;
    sights.picture = timed(view, job.view.depth, context, buffer, result.timings.visible);
  }
  if (plan.maps && !plan.shared) {
    view.samples = 1;
    std::vector<double> times;
    ZBuffer* const buffer = context.buffers ? &context.buffers->maps : nullptr;
    sights.maps = timed(view, job.view.depth, context, buffer, plan.picture_samples ? times : result.timings.visible);
    if (plan.picture_samples) result.timings.visible_maps = times.front();
  }
  return sights;
}

/// Returns the content hash, by the stream's own ids if the surfaces are an excerpt of a stream.
std::uint64_t hash_of(const Sights& sights) {
  if (!sights.stream_ids) return content_hash(sights.for_maps().visible);
  Visible visible = sights.for_maps().visible;
  for (PrimitiveId& id : visible.primitives)
    if (id != no_primitive) id = (*sights.stream_ids)[id];
  return content_hash(visible);
}

Image primitive_ids(const RenderContext& context, const Sights& sights) {
  Image image = id_image(context.surfaces, sights.for_maps().visible, IdKind::primitive);
  if (sights.stream_ids)
    for (std::uint32_t& id : image.channels.front().integers())
      if (id != no_index) id = (*sights.stream_ids)[id];
  return image;
}

Seen summary(const Surfaces& surfaces, const Sights& sights) {
  Seen seen;
  seen.hash = hash_of(sights);
  count_objects(surfaces, id_image(surfaces, sights.for_maps().visible, IdKind::object), seen);
  return seen;
}

Image window_depth_image(const SeenView& sight) {
  Image image{sight.visible.view.width, sight.visible.view.height, {}};
  image.channels.push_back({"window_depth", sight.window_depths});
  return image;
}

void warn_if_blank(const Sights& sights, const RenderContext& context, ViewResult& result) {
  if (!sights.is_blank()) return;
  // Unseen triangles of a stream are not in memory any more, so their causes were counted before.
  const std::string reason = sights.blank_reason ? sights.blank_reason->clause()
                                                 : blank_reason(context.surfaces, result.view, context.execution);
  result.warnings.push_back("nothing is in view: " + reason);
}

/// Warns about models that are hardly wider than a pixel: seen edge-on, or long and thin in a small picture.
void warn_if_thread(const Sights& sights, ViewResult& result) {
  constexpr double thinnest = 2.5;  // pixels, on average
  constexpr int shortest = 32;
  const Visible& visible = sights.pixels    ? sights.pixels->first
                           : sights.picture ? sights.picture->visible
                                            : sights.maps->visible;
  std::size_t count = 0;
  int left = visible.view.width, right = -1, top = visible.view.height, bottom = -1;
  const double most = thinnest * std::max(visible.view.width, visible.view.height);
  for (int y = 0; y < visible.view.height; ++y) {
    if (double(count) >= most) return;
    for (int x = 0; x < visible.view.width; ++x) {
      if (visible.primitives[visible.index(x, y)] == no_primitive) continue;
      ++count;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = y;
    }
  }
  const int length = std::max(right - left, bottom - top) + 1;
  if (length < shortest || double(count) >= thinnest * length) return;
  result.warnings.push_back(
      fmt::format("the visible part of the model is a thread, {} pixels long and {:.1f} wide on average; try another "
                  "--view or a larger --resolution",
                  length, double(count) / length));
}

/// Whether the picture has the 64 sub-samples of the A-buffer. Visibility then has one sample.
bool is_fine(const Job& job) { return job.view.samples == 64; }

}  // namespace

int picture_samples(const Job& job, const View& view) {
  if (is_fine(job)) return 1;
  int samples = 4;
  while (view.pixel_count() * std::size_t(samples) > most_samples) samples /= 2;
  return job.view.samples.value_or(samples);
}

Image map_of(OutputKind kind, const Job& job, const RenderContext& context, const Sights& sights) {
  const Visible& visible = sights.for_maps().visible;
  const float background = job.output.background_depth;
  switch (kind) {
    case OutputKind::depth: return depth_image(visible, background);
    case OutputKind::ray_distance: return ray_distance_image(visible, background);
    case OutputKind::window_depth: return window_depth_image(sights.for_maps());
    case OutputKind::normals: return context.shader.normal_image(visible, context.execution);
    case OutputKind::primitive_ids: return primitive_ids(context, sights);
    case OutputKind::object_ids: return id_image(context.surfaces, visible, IdKind::object);
    case OutputKind::material_ids: return id_image(context.surfaces, visible, IdKind::material);
    case OutputKind::picture:
    case OutputKind::deep: break;  // no map
  }
  return {};
}

void count_objects(const Surfaces& surfaces, const Image& objects, Seen& seen) {
  const std::vector<Instance>& instances = surfaces.scene().instances;
  const std::vector<std::uint64_t> pixels = count_pixels(objects, instances.size());
  for (std::uint32_t i = 0; i < pixels.size(); ++i) {
    seen.pixels += pixels[i];
    if (pixels[i] > 0) seen.objects.push_back({i, instances[i].name, pixels[i]});
  }
}

SightPlan plan_sights(const Job& job, const RunSettings& run, bool keep_picture, const View& view) {
  const bool picture = wants_picture(job, keep_picture) || wants(job, OutputKind::deep);
  SightPlan plan;
  if (picture) plan.picture_samples = picture_samples(job, view);
  plan.maps = wants_maps(job) || job.output.hash || run.json || !picture;
  plan.shared = plan.maps && plan.picture_samples == 1;
  return plan;
}

std::vector<View> views_of(const View& view, const SightPlan& plan) {
  std::vector<View> views;
  if (plan.picture_samples) views.push_back(view);
  if (plan.picture_samples) views.back().samples = *plan.picture_samples;
  if (plan.maps && !plan.shared) views.push_back(view);
  return views;
}

ViewResult render_view(const Job& job, const RenderContext& context) {
  if (job.view.camera_model != CameraModel::pinhole) return render_around(job, context);
  ViewResult result;
  result.name = job.name;
  result.depth = job.view.depth;
  result.view = resolve_view(job.view, context.framed_surfaces());
  result.target = focal_point_of(job.view, result.view, context.framed_surfaces());
  Sights sights = look(job, context, result);
  if (job.output.edges) {
    const Stopwatch watch;
    sights.edges = edges_of(context, result.view);
    result.timings.edges = watch.milliseconds();
  }
  finish_view(job, context, sights, result);
  write_layers(job, context, result);
  write_figures(job, context, sights, result);
  if (context.buffers && sights.picture) context.buffers->picture.give_back(std::move(sights.picture->visible));
  if (context.buffers && sights.maps) context.buffers->maps.give_back(std::move(sights.maps->visible));
  return result;
}

bool has_key_light(const Job& job) {
  return job.output.shading == Shading::lit && job.output.lights != Lights::file && job.output.lights != Lights::none;
}

ShadeOptions shade_options(const Job& job, const RenderContext& context) {
  ShadeOptions options{job.output.shading, job.output.background, job.output.opacity};
  options.light = context.environments.light(job.output.light, context.execution);
  options.light.shadows = job.output.shadows;
  const std::optional<Method> method = context.run.method;
  if (method) options.layers.see_through = *method == Method::abuffer ? SeeThrough::always : SeeThrough::never;
  if (job.view.depth.is_used) options.layers.see_through = SeeThrough::never;  // the depth state decides
  if (is_fine(job)) options.layers.grid = 8;
  options.light.lights = job.output.lights.value_or(options.light.lights);
  options.pixels.blend = job.output.blend;
  if (job.output.ambient_occlusion > 0)
    options.light.ambient_occlusion = {job.output.ambient_occlusion, job.output.occlusion_radius};
  return options;
}

void finish_view(const Job& job, const RenderContext& context, const Sights& sights, ViewResult& result) {
  if (job.output.hash || context.run.json) result.seen = summary(context.surfaces, sights);
  warn_if_blank(sights, context, result);
  warn_if_thread(sights, result);
  const ShadeOptions options = shade_options(job, context);
  const auto input = [&] { return sights.shade_input(context.index); };
  const Image* picture = nullptr;
  const Bitmap* bitmap = nullptr;
  std::optional<Image> with_edges;
  if (wants_picture(job, context.keep_picture)) {
    const Stopwatch watch;
    const Visible& visible = input().first();
    if (!context.keep_picture && needs_only_bitmap(job))
      bitmap = &context.shader.shade_bitmap(input(), options, context.execution);
    else
      picture = &context.shader.shade(input(), options, context.execution);
    if (sights.edges) {
      picture = &with_edges.emplace(context.shader.take());
      add_edges(*with_edges, *sights.edges, job, result.view, context.execution);
    }
    result.timings.shade += watch.milliseconds();
    const std::optional<glm::vec3>& background = job.output.background;
    if (background && !sights.has_edges() &&
        (picture ? nothing_stands_out(*picture, visible.primitives, *background)
                 : nothing_stands_out(*bitmap, visible.primitives, *background)))
      result.warnings.push_back(contrast_warning(is_invisible(context.surfaces, visible.primitives)));
  }
  const auto map = [&](OutputKind kind) { return map_of(kind, job, context, sights); };
  const auto deep = [&] { return context.shader.shade_deep(input(), options, context.execution); };
  if (job.output.reference) result.reference = compare_with_reference(*picture, job, context.execution);
  write_files({job, context.execution, map, picture, bitmap, deep}, result);
  if (context.keep_picture && picture) result.picture = with_edges ? std::move(*with_edges) : context.shader.take();
}

}  // namespace frontmost::cli
