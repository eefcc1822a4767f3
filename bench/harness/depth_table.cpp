// SPDX-License-Identifier: Apache-2.0
// The depth buffer with OpenGL's state beside the z-buffer, by every instruction set.
#include <thread>

#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kScenes[] = {"teapot",        "bunny",  "sphere1m", "terrain1m",
                                        "terrain1m-fly", "soup1m", "city-fly"};

}  // namespace

Table measure_depth_buffer(const Options& options) {
  std::vector<std::string> columns{"scene", "zbuffer", "depth", "times"};
  for (const Isa isa : available_isas()) columns.emplace_back(frontmost::name(isa));
  columns.emplace_back("all threads");
  Table table("depth buffer: D24, LESS, cleared and drawn in order; one thread, all", columns);
  const int threads = std::max(2, int(std::thread::hardware_concurrency()));
  for (const std::string_view name : options.scenes_or(kScenes)) {
    const Stage stage(name, options.models);
    Frames frames(stage);
    DepthBuffer buffer(stage.view.width, stage.view.height);
    const auto draw = [&](const Execution& execution) {
      buffer.clear();
      buffer.draw(stage.surfaces, stage.view, {}, execution);
    };
    std::vector<Contestant> contestants{Contestant([&] { frames.draw({.threads = 1}); }),
                                        Contestant([&] { draw({.threads = threads}); })};
    for (const Isa isa : available_isas()) contestants.emplace_back([&draw, isa] { draw({.threads = 1, .isa = isa}); });
    const std::vector<Time> times = race(contestants, options.sampling);
    const double zbuffer = times[0].processor, depth = times.back().processor;
    std::vector<Cell> row{name, {zbuffer}, {depth}, {depth / zbuffer, 1}};
    for (std::size_t i = 2; i < times.size(); ++i) row.emplace_back(times[i].processor);
    row.emplace_back(times[1].wall);
    table.add(row);
  }
  return table;
}

}  // namespace frontmost::bench
