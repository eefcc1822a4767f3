// SPDX-License-Identifier: Apache-2.0
// Cost of depth complexity in time and in memory.
#include "abuffer/tables.h"
#include "harness/measure.h"

namespace frontmost::bench {
namespace {

constexpr double kMiB = 1024.0 * 1024.0;

struct LargePicture {
  int layers, width, height, grid;
  double most_mib;
};
constexpr LargePicture kLargePictures[] = {
    {100, 640, 360, 0, 256}, {100, 640, 360, 8, 256}, {500, 640, 360, 0, 256}, {500, 640, 360, 8, 256}};

}  // namespace

Table measure_layers(const Options& options) {
  // Layers are so thin that all of them are shaded.
  constexpr float kOpacity = 0.01f;
  Table table("sheets that fill 240 x 135 pixels, one thread",
              {"sheets", "sub-samples", "ms", "ns a fragment", "of these to count it"});
  for (const int count : {1, 10, 50, 100, 200, 500}) {
    const Stage stage = make_sheets(count, 240, 135);
    for (const int grid : grids(options)) {
      const AbufferOptions sampling{grid, kOpacity};
      const Execution execution{.threads = 1};
      const std::vector<Time> times =
          race({Contestant([&] { (void)draw_layers(stage, sampling, execution); }),
                Contestant([&] { (void)count_fragments(stage.surfaces, stage.view, sampling, execution); })},
               options.sampling);
      const double fragments = double(stage.view.pixel_count()) * count;
      table.add({std::to_string(count),
                 Cell::whole(unsigned(samples_of(grid))),
                 {times[0].processor},
                 {1e6 * times[0].processor / fragments, 1},
                 {1e6 * times[1].processor / fragments, 1}});
    }
  }
  return table;
}

Table measure_abuffer_memory(const Options&) {
  // With this opacity, some eighty of a hundred layers are shaded; layers behind them add nothing.
  constexpr float kOpacity = 0.3f;
  Table table("memory of one picture, all threads",
              {"picture", "sub-samples", "ms", "MiB", "of these planes", "at most"});
  for (const LargePicture& p : kLargePictures) {
    const Stage stage = make_sheets(p.layers, p.width, p.height);
    reset_peak();
    const std::size_t before = resident_bytes();
    const Time start = now();
    const Image picture = draw_layers(stage, {p.grid, kOpacity}, {});
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
