// SPDX-License-Identifier: Apache-2.0
// Hidden lines: feature edges, and what it takes to cut them.
#include <algorithm>
#include <thread>

#include "drawings/tables.h"
#include "harness/stage.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kScenes[] = {"teapot", "bunny", "sphere1m", "terrain1m", "city-fly", "boxes-random"};

}  // namespace

Table measure_lines(const Options& options) {
  Table table("hidden lines, ms", {"scene", "edges", "parts", "one thread", "no crossings", "all threads", "times"});
  const int all = std::max(2, int(std::thread::hardware_concurrency()));
  for (const std::string_view name : options.scenes_or(kScenes)) {
    const Stage stage(name, options.models);
    const Drawing drawing = draw_lines(stage.surfaces, stage.view);
    const auto draw = [&](bool intersections, int threads) {
      return Contestant([&stage, intersections, threads] {
        (void)draw_lines(stage.surfaces, stage.view, {.intersections = intersections}, {.threads = threads});
      });
    };
    const std::vector<Time> times = race({draw(true, 1), draw(false, 1), draw(true, all)}, options.sampling);
    table.add({name,
               Cell::whole(drawing.edges.size()),
               Cell::whole(drawing.parts.size()),
               {cost(times[0], 1)},
               {cost(times[1], 1)},
               {cost(times[2], all)},
               {times[0].wall / times[2].wall}});
  }
  return table;
}

}  // namespace frontmost::bench
