// SPDX-License-Identifier: Apache-2.0
// A-buffer pictures by one thread and by all, and by every instruction set.
#include <algorithm>
#include <thread>

#include "abuffer/tables.h"

namespace frontmost::bench {

Table measure_abuffer_threads(const Options& options) {
  const int threads = std::max(2, int(std::thread::hardware_concurrency()));
  Table table("threads", {"scene", "sub-samples", "threads", "1 thread", "all threads", "times"});
  for (const SceneEntry& entry : translucent_entries()) {
    if (!options.wants_scene(entry)) continue;
    const Stage stage = make_lit(entry.name, options.models);
    for (const int grid : grids(options)) {
      const auto draw = [&](int count) { (void)draw_layers(stage, {grid, opacity_of_copies}, {.threads = count}); };
      const std::vector<Time> times =
          race({Contestant([&] { draw(1); }), Contestant([&] { draw(threads); })}, options.sampling);
      table.add({entry.name,
                 Cell::whole(unsigned(samples_of(grid))),
                 Cell::whole(unsigned(threads)),
                 {times[0].wall},
                 {times[1].wall},
                 {times[0].wall / times[1].wall}});
    }
  }
  return table;
}

Table measure_abuffer_isas(const Options& options) {
  Table table("instruction sets, one thread", {"scene", "sub-samples", "set", "ms", "speed"});
  for (const SceneEntry& entry : translucent_entries()) {
    if (!options.wants_scene(entry)) continue;
    const Stage stage = make_lit(entry.name, options.models);
    for (const int grid : grids(options)) {
      std::vector<Contestant> contestants;
      for (const Isa isa : available_isas())
        contestants.emplace_back([&stage, grid, isa] {
          (void)draw_layers(stage, {grid, opacity_of_copies}, {.threads = 1, .isa = isa});
        });
      const std::vector<Time> times = race(contestants, options.sampling);
      for (std::size_t i = 0; i < times.size(); ++i)
        table.add({entry.name,
                   Cell::whole(unsigned(samples_of(grid))),
                   frontmost::name(available_isas()[i]),
                   {times[i].processor},
                   {times.back().processor / times[i].processor}});
    }
  }
  return table;
}

}  // namespace frontmost::bench
