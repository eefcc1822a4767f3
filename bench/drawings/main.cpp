// SPDX-License-Identifier: Apache-2.0
// drawings_bench [TABLE]... [--scene NAME]... [--rounds N] [--json FILE]
// Measures hidden lines, the painter's order, and hatching and dots; docs/performance.md says what the tables mean.
#include <algorithm>
#include <thread>

#include "frontmost/lines.h"
#include "harness/program.h"
#include "harness/stage.h"

namespace frontmost::bench {
namespace {

constexpr std::string_view kScenes[] = {"teapot", "bunny", "sphere1m", "terrain1m", "city-fly", "boxes-random"};
/// Limit of cuts for the painter, above the default: BSP trees cut a terrain of a million triangles more often.
constexpr std::size_t kMostCuts = std::size_t(1) << 26;
/// Spacing of hatch lines and dots in pixels, about a millimetre on a sheet of A4.
constexpr double kSpacing = 7;

/// Hidden lines: finding feature edges and cutting them, with and without intersections, and on all threads.
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

/// The painter's order beside the z-buffer, in the steps that a figure takes. The table fails if the painted order
/// differs from the z-buffer's picture without a reason.
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

/// Hatching and dots, with and without cast shadows, and on all threads.
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

}  // namespace
}  // namespace frontmost::bench

int main(int count, char** arguments) {
  using namespace frontmost::bench;
  constexpr TableEntry kTables[] = {{"lines", measure_lines}, {"painter", measure_painter}, {"tones", measure_tones}};
  return run_program("drawings_bench", kTables, count, arguments);
}
