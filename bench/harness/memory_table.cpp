// SPDX-License-Identifier: Apache-2.0
// Memory that is requested, and how near a frame comes to the limits of memory and processor.
#include <cmath>

#include "harness/measure.h"
#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kVaried[] = {"teapot",        "bunny",     "sphere1m", "sphere4m", "terrain1m",
                                        "terrain1m-fly", "terrain4m", "soup1m",   "city-fly", "boxes-random"};
constexpr double kMostBytesPerTriangle = 64, kMostBytesPerSample = 16;

View with_size(View view, int side, int samples) {
  view.width = view.height = side;
  view.samples = samples;
  return view;
}

}  // namespace

Table measure_limits(const Options& options) {
  const MachineLimits machine = measure_machine();
  Table table("limits, one thread",
              {"scene", "ms", "memory ms", "share %", "Mtri/s", "cycles/tri", "cycles/pixel", "GB/s"});
  table.add({"this machine", "", "", "", "", {machine.clock / 1e6, 2}, "GHz", {machine.fill / 1e6, 1}});
  table.add({"  reading", "", "", "", "", "", "", {machine.read / 1e6, 1}});
  for (const std::string_view name : options.scenes_or(kVaried)) {
    const Stage stage(name, options.models);
    Frames frames(stage);
    const double ms = race({Contestant([&] { frames.draw({.threads = 1}); })}, options.sampling)[0].processor;
    const double written = double(stage.view.pixel_count()) * (sizeof(PrimitiveId) + sizeof(float));
    const double read = double(stage.surfaces.byte_count()), triangles = stage.surfaces.primitive_count();
    const double floor = written / machine.fill + read / machine.read;
    table.add({name,
               {ms},
               {floor},
               {100 * floor / ms, 0},
               {triangles / ms / 1e3, 1},
               {ms * machine.clock / triangles, 1},
               {ms * machine.clock / double(stage.view.pixel_count()), 1},
               {(written + read) / ms / 1e6, 1}});
  }
  return table;
}

Table measure_memory(const Options& options) {
  Table table("memory", {"what", "bytes", "at most"});
  for (const std::string_view name : options.scenes_or(kVaried)) {
    const Stage stage(name, options.models);
    stage.surfaces.make_clusters();
    table.add({std::string("a triangle, ").append(name),
               {double(stage.surfaces.byte_count()) / stage.surfaces.primitive_count(), 1},
               {kMostBytesPerTriangle, 0}});
  }
  const Stage stage("terrain1m-fly", options.models);
  for (const int side : {1024, 4096})
    for (const int samples : {1, 4}) {
      const View view = with_size(stage.view, side, samples);
      reset_peak();
      const std::size_t before = resident_bytes();
      Frames frames(stage.surfaces, view);
      for (int frame = 0; frame < 2; ++frame) frames.draw({.threads = 1});
      const double bytes = double(peak_resident_bytes()) - double(before);
      table.add({std::to_string(side).append("^2 pixels, samples: ").append(std::to_string(samples)),
                 {bytes / double(view.sample_count()), 1},
                 {kMostBytesPerSample, 0}});
    }
  return table;
}

}  // namespace frontmost::bench
