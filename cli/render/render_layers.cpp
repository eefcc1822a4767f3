// SPDX-License-Identifier: Apache-2.0
// render --layers: the A-buffer finds the nearest K surfaces of each sample at once. Each layer then gets a picture and
// maps of its own, shaded as if nothing were in front of it.
#include <frontmost/abuffer.h>
#include <frontmost/pictures.h>

#include <algorithm>

#include "cli/render/output_writer.h"
#include "cli/stopwatch.h"

namespace frontmost::cli {
namespace {

constexpr std::size_t most_layer_samples = std::size_t(1) << 30;  // 8 GiB

std::vector<Visible> layers_of(const Job& job, const RenderContext& context, const View& view) {
  const int count = *job.output.layers;
  if (view.sample_count() * std::size_t(count) > most_layer_samples)
    throw Error(ErrorCode::limit_exceeded, "--layers: more than 2^30 samples in all layers; ask for fewer, or --deep");
  return visible_layers(context.surfaces, view, count, {0, job.output.opacity}, context.execution);
}

/// A layer with its files.
struct LayerFiles {
  Job job;
  const Visible* picture;  ///< null if no file shows it
  const Visible* maps;     ///< null if no file needs it
};

void write_layer(const LayerFiles& layer, const RenderContext& context, ViewResult& result) {
  const Image* picture = nullptr;
  if (wants(layer.job, OutputKind::picture)) {
    const Stopwatch watch;
    ShadeOptions options = shade_options(layer.job, context);
    options.layers.see_through = SeeThrough::never;
    picture = &context.shader.shade({.visible = layer.picture, .index = context.index}, options, context.execution);
    result.timings.shade += watch.milliseconds();
  }
  Sights sights;
  if (layer.maps) sights.maps = SeenView{*layer.maps, {}};
  const auto map = [&](OutputKind kind) { return map_of(kind, layer.job, context, sights); };
  write_files({layer.job, context.execution, map, picture}, result);
}

bool shows_only_picture(const FileToWrite& file) {
  return file.kinds.size() == 1 && file.kinds.front() == OutputKind::picture;
}

}  // namespace

void write_layers(const Job& job, const RenderContext& context, ViewResult& result) {
  if (job.layer_files.empty()) return;
  Job all = job;
  all.files = job.layer_files;
  View view = result.view;
  std::vector<Visible> pictures, maps;
  if (wants(all, OutputKind::picture)) {
    view.samples = picture_samples(job, view);
    pictures = layers_of(job, context, view);
  }
  if (!std::all_of(all.files.begin(), all.files.end(), shows_only_picture)) {
    view.samples = 1;
    maps = layers_of(job, context, view);
  }
  for (int k = 0; k < *job.output.layers; ++k) {
    LayerFiles layer{job, pictures.empty() ? nullptr : &pictures[std::size_t(k)],
                     maps.empty() ? nullptr : &maps[std::size_t(k)]};
    layer.job.files.clear();
    for (const FileToWrite& file : job.layer_files)
      if (file.layer == k) layer.job.files.push_back(file);
    write_layer(layer, context, result);
  }
}

}  // namespace frontmost::cli
