// SPDX-License-Identifier: Apache-2.0
// The painter's order, step by step as a figure takes them.
#include <algorithm>
#include <thread>

#include "drawings/tables.h"
#include "harness/stage.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kScenes[] = {"teapot", "bunny", "sphere1m", "terrain1m", "city-fly", "boxes-random"};
/// Beyond the default: BSP trees cut a terrain of a million triangles more often.
constexpr std::size_t kMostCuts = std::size_t(1) << 26;

}  // namespace

Table measure_painter(const Options& options) {
  const int threads = options.threads;
  Table table(std::string("painter's order, ms, threads: ").append(std::to_string(threads)),
              {"scene", "polygons", "order", "BSP", "seen parts", "left", "figure", "wrong"});
  for (const std::string_view name : options.scenes_or(kScenes)) {
    const Stage stage(name, options.models);
    const Execution execution{.threads = threads};
    const auto order_by = [&](PaintMethod method) {
      return painter(stage.surfaces, stage.view, {.method = method, .most_cuts = kMostCuts}, execution);
    };
    const PaintOrder order = order_by(PaintMethod::depth_sort);
    const VisibleParts seen = visible_parts(order, Occluders::all(), execution);
    const std::vector<Time> times =
        race({Contestant([&] { (void)order_by(PaintMethod::depth_sort); }),
              Contestant([&] { (void)order_by(PaintMethod::bsp); }),
              Contestant([&] { (void)visible_parts(order, Occluders::all(), execution); }),
              Contestant([&] { (void)draw_figure(stage.surfaces, stage.view, {}, execution); })},
             options.sampling);
    const Agreement agreed =
        check_agreement(stage.surfaces, zbuffer(stage.surfaces, stage.view), paint(stage.surfaces, order));
    const std::uint64_t wrong = agreed.count(Difference::unexplained);
    const auto ms = [&](std::size_t i) { return Cell(cost(times[i], threads)); };
    table.add({name, Cell::whole(order.polygons.size()), ms(0), ms(1), ms(2), Cell::whole(seen.polygons.size()), ms(3),
               Cell::whole(wrong)});
    if (wrong != 0) table.fail();
  }
  return table;
}

}  // namespace frontmost::bench
