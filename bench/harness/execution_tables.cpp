// SPDX-License-Identifier: Apache-2.0
// Z-buffer frames by one thread and by all, and by every instruction set.
#include <algorithm>
#include <cmath>
#include <thread>

#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

constexpr double kThreadTarget = 0.9;  // speed-up wanted, as a share of the number of threads
constexpr std::string_view kMillions[] = {"sphere1m", "terrain1m", "terrain1m-fly", "soup1m"};
constexpr std::string_view kVaried[] = {"teapot", "bunny",    "sphere1m",    "terrain1m-fly",
                                        "soup1m", "city-fly", "boxes-random"};

/// Wanted speed of an instruction set, relative to AVX-512.
double isa_target(Isa isa) {
  switch (isa) {
    case Isa::avx2: return 0.6;
    case Isa::sse4: return 0.35;
    case Isa::scalar:
    case Isa::avx512:
    case Isa::best: break;
  }
  return std::nan("");
}

}  // namespace

Table measure_threads(const Options& options) {
  const int threads = std::max(2, int(std::thread::hardware_concurrency()));
  Table table("threads", {"scene", "threads", "1 thread", "all threads", "times", "target", "processor"});
  for (const std::string_view name : options.scenes_or(kMillions)) {
    const Stage stage(name, options.models);
    Frames one(stage), all(stage);
    const std::vector<Time> times =
        race({Contestant([&] { one.draw({.threads = 1}); }), Contestant([&] { all.draw({.threads = threads}); })},
             options.sampling);
    table.add({name,
               Cell::whole(unsigned(threads)),
               {times[0].wall},
               {times[1].wall},
               {times[0].wall / times[1].wall},
               {kThreadTarget * threads},
               {times[1].processor}});
  }
  return table;
}

Table measure_isas(const Options& options) {
  Table table("instruction sets, one thread", {"scene", "set", "ms", "speed", "target"});
  for (const std::string_view name : options.scenes_or(kVaried)) {
    const Stage stage(name, options.models);
    Frames frames(stage);
    std::vector<Contestant> contestants;
    for (const Isa isa : available_isas())
      contestants.emplace_back([&frames, isa] { frames.draw({.threads = 1, .isa = isa}); });
    const std::vector<Time> times = race(contestants, options.sampling);
    const bool has_widest = available_isas().back() == Isa::avx512;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const Isa isa = available_isas()[i];
      table.add({name,
                 frontmost::name(isa),
                 {times[i].processor},
                 {times.back().processor / times[i].processor},
                 {has_widest ? isa_target(isa) : std::nan("")}});
    }
  }
  return table;
}

}  // namespace frontmost::bench
