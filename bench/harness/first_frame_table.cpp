// SPDX-License-Identifier: Apache-2.0
// Cost of one frame from the scene on, in new memory: with clusters and without.
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
  Table table("surfaces: making ready, with clusters and a frame of them, and a frame from the scene's own arrays",
              {"scene", "threads", "surfaces", "clusters", "ns/tri", "and a frame", "one shot", "times"});
  for (const std::string_view name : options.scenes_or(kScenes)) {
    const Stage stage(name, options.models);
    for (const int threads : {1, std::max(2, int(std::thread::hardware_concurrency()))}) {
      const Execution execution{.threads = threads};
      const std::vector<Time> times =
          race({Contestant([&] { const Surfaces surfaces(stage.scene, execution); }), Contestant([&] {
                  const Surfaces surfaces(stage.scene, execution);
                  surfaces.make_clusters(execution);
                }),
                Contestant([&] {
                  const Surfaces surfaces(stage.scene, execution);
                  ZBuffer buffer;
                  buffer.draw(surfaces, stage.view, execution);
                }),
                Contestant([&] {
                  const Surfaces surfaces(stage.scene, execution);
                  const Visible visible = zbuffer(surfaces, stage.view, execution);
                })},
               options.sampling);
      const double placed = cost(times[0], threads), ready = cost(times[1], threads), framed = cost(times[2], threads),
                   once = cost(times[3], threads);
      table.add({name,
                 Cell::whole(unsigned(threads)),
                 {placed},
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
