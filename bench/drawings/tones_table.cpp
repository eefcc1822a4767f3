// SPDX-License-Identifier: Apache-2.0
// Hatching and stippling, with the shadows that are cast.
#include <algorithm>
#include <thread>

#include "drawings/tables.h"
#include "frontmost/hatching.h"
#include "harness/stage.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kScenes[] = {"teapot", "bunny", "sphere1m", "terrain1m", "city-fly", "boxes-random"};
/// Pixels: about a millimetre on a sheet of A4.
constexpr double kSpacing = 7;

}  // namespace

Table measure_tones(const Options& options) {
  Table table("hatching and dots, ms",
              {"scene", "lines", "one thread", "no shadows", "all threads", "times", "dots", "one thread"});
  const int all = std::max(2, int(std::thread::hardware_concurrency()));
  const StippleOptions dots{.spacing = kSpacing};
  for (const std::string_view name : options.scenes_or(kScenes)) {
    const Stage stage(name, options.models);
    const auto hatched = [&stage](bool shadows, int threads) {
      HatchOptions hatching{.sets = hatch_sets(kSpacing, 0.8)};
      hatching.tone.casts_shadows = shadows;
      return hatch(stage.surfaces, stage.view, hatching, {.threads = threads});
    };
    const std::size_t lines = hatched(true, all).size();
    const std::size_t dot_count = stipple(stage.surfaces, stage.view, dots, {.threads = all}).size();
    const std::vector<Time> times =
        race({Contestant([&] { (void)hatched(true, 1); }), Contestant([&] { (void)hatched(false, 1); }),
              Contestant([&] { (void)hatched(true, all); }),
              Contestant([&] { (void)stipple(stage.surfaces, stage.view, dots, {.threads = 1}); })},
             options.sampling);
    table.add({name,
               Cell::whole(lines),
               {cost(times[0], 1)},
               {cost(times[1], 1)},
               {cost(times[2], all)},
               {times[0].wall / times[2].wall},
               Cell::whole(dot_count),
               {cost(times[3], 1)}});
  }
  return table;
}

}  // namespace frontmost::bench
