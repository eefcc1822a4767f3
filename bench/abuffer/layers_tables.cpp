// SPDX-License-Identifier: Apache-2.0
// Depth complexity: what it costs in time and in memory.
#include "abuffer/pictures.h"
#include "abuffer/tables.h"
#include "harness/machine.h"

namespace frontmost::bench {
namespace {

constexpr double kMiB = 1024.0 * 1024.0;

std::vector<glm::vec4> thin_colors(const Stage& stage) {
  return std::vector<glm::vec4>(stage.surfaces.primitive_count(), glm::vec4(0.5f, 0.5f, 0.5f, 0.01f));
}

struct LargePicture {
  int layers, width, height, grid;
  double most_mib;
};
constexpr LargePicture kLargePictures[] = {
    {500, 1920, 1080, 0, 1024}, {500, 1920, 1080, 8, 1024}, {100, 3840, 2160, 0, 1024}, {100, 3840, 2160, 8, 1024}};

}  // namespace

Table measure_layers(const Options& options) {
  Table table("sheets that fill 480 x 270 pixels, one thread", {"sheets", "sub-samples", "ms", "ns a fragment"});
  for (const int count : {1, 10, 50, 100, 200, 500}) {
    const Stage stage = make_sheets(count, 480, 270);
    const std::vector<glm::vec4> colors = thin_colors(stage);
    for (const int grid : grids(options)) {
      Resolver resolver;
      const auto draw = [&] { resolver.draw(stage.surfaces, stage.view, colors, {grid}, {.threads = 1}); };
      const double ms = race({Contestant(draw)}, options.sampling)[0].processor;
      table.add({std::to_string(count),
                 Cell::whole(unsigned(samples_of(grid))),
                 {ms},
                 {1e6 * ms / (double(stage.view.pixel_count()) * count), 1}});
    }
  }
  return table;
}

Table measure_abuffer_memory(const Options&) {
  Table table("memory of one picture, all threads",
              {"picture", "sub-samples", "ms", "MiB", "of these planes", "at most"});
  for (const LargePicture& p : kLargePictures) {
    const Stage stage = make_sheets(p.layers, p.width, p.height);
    const std::vector<glm::vec4> colors = thin_colors(stage);
    reset_peak();
    const std::size_t before = resident_bytes();
    const Time start = now();
    const ResolvedPicture picture = resolve(stage.surfaces, stage.view, colors, {p.grid});
    const double ms = now().wall - start.wall;
    const double mib = (double(peak_resident_bytes()) - double(before)) / kMiB;
    const std::string name = std::to_string(p.layers) + " layers, " + std::to_string(p.width) + " x ";
    table.add({name + std::to_string(p.height),
               Cell::whole(unsigned(samples_of(p.grid))),
               {ms, 0},
               {mib, 0},
               {4.0 * sizeof(float) * double(stage.view.pixel_count()) / kMiB, 0},
               {p.most_mib, 0}});
    if (mib > p.most_mib) table.fail();
  }
  return table;
}

}  // namespace frontmost::bench
