// SPDX-License-Identifier: Apache-2.0
// Pairs of faces that a depth buffer cannot tell apart, beside the picture that the search starts from.
#include <frontmost/precision.h>

#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kScenes[] = {"teapot", "bunny", "sphere100k", "city-fly", "city-street", "soup100k"};

}  // namespace

Table measure_fights(const Options& options) {
  Table table("fights: areas at risk with 24 bits, 1920 x 1080; ms",
              {"scene", "triangles", "areas", "pairs of objects", "zbuffer", "one thread", "all threads"});
  const Execution one{.threads = 1};
  for (const std::string_view name : options.scenes_or(kScenes)) {
    const Stage stage(name, options.models);
    FightAreas found;
    const std::vector<Time> times = race(
        {Contestant([&] { (void)zbuffer(stage.surfaces, stage.view, one); }),
         Contestant([&] { found = find_fighting_faces(stage.surfaces, stage.view, DepthFormat::d24, false, one); }),
         Contestant([&] { (void)find_fighting_faces(stage.surfaces, stage.view, DepthFormat::d24); })},
        options.sampling);
    table.add({name,
               Cell::whole(stage.surfaces.primitive_count()),
               Cell::whole(found.faces.size()),
               Cell::whole(found.objects.size()),
               {times[0].processor, 1},
               {times[1].processor, 1},
               {times[2].wall, 1}});
  }
  return table;
}

}  // namespace frontmost::bench
