// SPDX-License-Identifier: Apache-2.0
// One view. The picture has several samples a pixel; maps, the report and the hash have one, at pixel centres, so that
// they do not depend on how smooth the picture is to be.
#include "render_view.h"

#include <fmt/format.h>
#include <frontmost/shade.h>

#include "blank.h"
#include "interruption.h"
#include "reference.h"
#include "sight.h"
#include "stopwatch.h"
#include "view_options.h"

namespace frontmost::cli {
namespace {

/// Samples of a picture that asks for none: 4, or as many as the largest pictures can have.
int default_samples(const View& view) {
  int samples = 4;
  while (view.pixel_count() * std::size_t(samples) > most_samples) samples /= 2;
  return samples;
}

bool wants(const Job& job, OutputKind kind) {
  for (const OutputFile& file : job.files) {
    if (std::find(file.kinds.begin(), file.kinds.end(), kind) != file.kinds.end()) return true;
  }
  return false;
}

bool wants_maps(const Job& job) {
  for (const OutputFile& file : job.files) {
    if (file.kinds.size() > 1 || file.kinds.front() != OutputKind::picture) return true;
  }
  return false;
}

/// The visibility that a view needs: of the picture, of the maps, or of both at once.
struct Sights {
  std::optional<Sight> picture, maps;
  bool shared = false;  ///< the maps are those of the picture

  [[nodiscard]] const Sight& for_maps() const { return shared ? *picture : *maps; }
  [[nodiscard]] const Visible& any() const { return (picture ? *picture : *maps).visible; }
};

Sight timed(const View& view, const DepthSettings& depth, const RenderContext& context, std::vector<double>& times) {
  for (int i = 1;; ++i) {
    const Stopwatch watch;
    Sight sight = look_at_surfaces(context.surfaces, view, depth, context.execution, context.index);
    times.push_back(watch.milliseconds());
    if (i >= context.run.repeat) return sight;
  }
}

Sights look(const Job& job, const RenderContext& context, ViewResult& result) {
  const bool picture = wants(job, OutputKind::picture) || context.keep_picture || job.output.reference;
  const bool maps = wants_maps(job) || job.output.hash || context.run.json || !picture;
  View view = result.view;
  Sights sights;
  if (picture) {
    view.samples = job.view.samples.value_or(default_samples(view));
    sights.picture = timed(view, job.view.depth, context, result.timings.visible);
    sights.shared = maps && view.samples == 1;
  }
  if (maps && !sights.shared) {
    view.samples = 1;
    std::vector<double> times;
    sights.maps = timed(view, job.view.depth, context, picture ? times : result.timings.visible);
    if (picture) result.timings.visible_maps = times.front();
  }
  return sights;
}

Seen summary(const Surfaces& surfaces, const Visible& visible) {
  Seen seen;
  seen.hash = content_hash(visible);
  const Image objects = id_image(surfaces, visible, IdKind::object);
  const std::vector<Instance>& instances = surfaces.scene().instances;
  std::vector<std::uint64_t> pixels(instances.size());
  for (const std::uint32_t object : objects.channels.front().integers()) {
    if (object != no_index) ++pixels[object];
  }
  for (std::uint32_t i = 0; i < pixels.size(); ++i) {
    seen.pixels += pixels[i];
    if (pixels[i] > 0) seen.objects.push_back({i, instances[i].name, pixels[i]});
  }
  return seen;
}

Image window_depth_image(const Sight& sight) {
  Image image{sight.visible.view.width, sight.visible.view.height, {}};
  image.channels.push_back({"window_depth", sight.window_depths});
  return image;
}

Image map_of(OutputKind kind, const Job& job, const RenderContext& context, const Sight& sight) {
  const Visible& visible = sight.visible;
  const float background = job.output.background_depth;
  switch (kind) {
    case OutputKind::depth: return depth_image(visible, background);
    case OutputKind::ray_distance: return ray_distance_image(visible, background);
    case OutputKind::window_depth: return window_depth_image(sight);
    case OutputKind::normals: return normal_image(context.surfaces, visible, context.execution);
    case OutputKind::primitive_ids: return id_image(context.surfaces, visible, IdKind::primitive);
    case OutputKind::object_ids: return id_image(context.surfaces, visible, IdKind::object);
    case OutputKind::material_ids: return id_image(context.surfaces, visible, IdKind::material);
    case OutputKind::picture: break;  // not a map
  }
  return {};
}

/// PFM holds three channels; there the picture is without its alpha.
Image without_alpha(const Image& picture) {
  Image copy = picture;
  if (copy.channels.size() == 4) copy.channels.pop_back();
  return copy;
}

void append(Image& image, Image part) {
  image.width = part.width;
  image.height = part.height;
  for (Channel& channel : part.channels) image.channels.push_back(std::move(channel));
}

SaveOptions save_options(const OutputFile& file, const OutputSettings& settings) {
  SaveOptions options;
  options.format = file.format;
  options.bits = settings.bits;
  options.depth_scale = settings.depth_scale;
  return options;
}

/// What all files of a view are made from.
struct Source {
  const Job& job;
  const RenderContext& context;
  const Sights& sights;
  const Image* picture;
};

void note(const Image& part, OutputKind kind, const OutputFile& file, const Source& source, ViewResult& result) {
  Result& one = result.results.emplace_back(Result{std::string(kind_name(kind)), file.path, {}});
  if (source.job.output.hash) one.hash = content_hash(part);
}

/// The channels of every kind that the file holds.
Image compose(const OutputFile& file, const Source& source, ViewResult& result) {
  Image image;
  for (const OutputKind kind : file.kinds) {
    Image part;
    if (kind != OutputKind::picture) {
      part = map_of(kind, source.job, source.context, source.sights.for_maps());
    } else {
      part = file.format == ImageFormat::pfm ? without_alpha(*source.picture) : *source.picture;
    }
    note(part, kind, file, source, result);
    append(image, std::move(part));
  }
  return image;
}

void save_image(const Image& image, const OutputFile& file, const Source& source, ViewResult& result) {
  const Stopwatch watch;
  const WritingFiles writing;
  save(image, file.path, save_options(file, source.job.output), source.context.execution);
  result.timings.save += watch.milliseconds();
}

void write(const OutputFile& file, const Source& source, ViewResult& result) {
  // A picture on its own is saved as it is: copying one takes as long as finding what is visible.
  const bool as_it_is =
      file.kinds.size() == 1 && file.kinds.front() == OutputKind::picture && file.format != ImageFormat::pfm;
  if (as_it_is) {
    note(*source.picture, OutputKind::picture, file, source, result);
    save_image(*source.picture, file, source, result);
  } else {
    save_image(compose(file, source, result), file, source, result);
  }
}

void warn_if_blank(const Sights& sights, const RenderContext& context, ViewResult& result) {
  if (!is_blank(sights.any())) return;
  result.warnings.push_back(fmt::format("nothing is in view: {}", blank_reason(context.surfaces, result.view)));
}

}  // namespace

ViewResult render_view(const Job& job, const RenderContext& context) {
  ViewResult result;
  result.name = job.name;
  result.depth = job.view.depth;
  result.view = resolve_view(job.view, context.surfaces);
  result.target = job.view.focal_point.value_or(focal_point_of(result.view, context.surfaces));
  const Sights sights = look(job, context, result);
  if (job.output.hash || context.run.json) result.seen = summary(context.surfaces, sights.for_maps().visible);
  warn_if_blank(sights, context, result);
  std::optional<Image> picture;
  if (sights.picture) {
    const Stopwatch watch;
    picture = shade(context.surfaces, sights.picture->visible,
                    {job.output.shading, job.output.background, !job.output.no_shadows}, context.execution);
    result.timings.shade = watch.milliseconds();
  }
  for (const OutputFile& file : job.files) {
    stop_if_interrupted();
    write(file, {job, context, sights, picture ? &*picture : nullptr}, result);
  }
  if (job.output.reference) result.reference = compare_with_reference(*picture, job, context.execution);
  if (context.keep_picture) result.picture = std::move(picture);
  return result;
}

}  // namespace frontmost::cli
