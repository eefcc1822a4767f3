// SPDX-License-Identifier: Apache-2.0
// What one frame costs from the scene on, in new memory: with clusters and without.
#include <algorithm>
#include <thread>

#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kScenes[] = {"teapot",       "bunny",         "sphere100k",   "sphere1m", "sphere4m",
                                        "terrain1m",    "terrain1m-fly", "terrain4m",    "soup1m",   "city-fly",
                                        "boxes-in",     "boxes-out",     "boxes-random", "huge",     "outside",
                                        "city-no-wall", "city-wall"};

}  // namespace

Table measure_surfaces(const Options& options) {
  Table table("surfaces: making ready, alone and with the first frame, and a frame from the scene's own arrays",
              {"scene", "threads", "surfaces", "ns/tri", "and a frame", "one shot", "times"});
  for (const std::string_view name : options.scenes_or(kScenes)) {
    const Stage stage(name, options.models);
    for (const int threads : {1, std::max(2, int(std::thread::hardware_concurrency()))}) {
      const Execution execution{.threads = threads};
      const std::vector<Time> times =
          race({Contestant([&] { const Surfaces surfaces(stage.scene, execution); }), Contestant([&] {
                  const Surfaces surfaces(stage.scene, execution);
                  const Visible visible = zbuffer(surfaces, stage.view, execution);
                }),
                Contestant([&] { const Visible visible = zbuffer(stage.scene, stage.view, execution); })},
               options.sampling);
      const double ready = cost(times[0], threads), framed = cost(times[1], threads), once = cost(times[2], threads);
      table.add({name,
                 Cell::whole(unsigned(threads)),
                 {ready},
                 {1e6 * ready / stage.surfaces.primitive_count(), 0},
                 {framed},
                 {once},
                 {framed / once}});
    }
  }
  return table;
}

}  // namespace frontmost::bench
