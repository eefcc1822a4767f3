// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "harness/stage.h"
#include "harness/tables.h"
#include "peers/peer.h"

namespace frontmost::bench {
namespace {

/// What counts: one thread's processor time is the steadier clock; of several threads the wall's is the answer.
double cost(const Time& time, int threads) { return threads == 1 ? time.processor : time.wall; }

void measure(const SceneEntry& entry, const Options& options, Table& table) {
  const Stage stage(entry.name, options.models);
  const PeerInput input{stage.scene, stage.view, options.threads};
  const auto llvmpipe = options.llvmpipe ? make_llvmpipe(input) : nullptr;
  const auto embree = options.embree ? make_embree(input) : nullptr;
  Frames frames(stage);
  std::vector<std::function<void()>> contestants{[&] { frames.draw({.threads = options.threads}); }};
  if (llvmpipe) contestants.emplace_back([&] { llvmpipe->draw(); });
  if (embree) contestants.emplace_back([&] { embree->draw(); });
  const std::vector<Time> times = race(contestants, options.sampling);

  const double none = std::nan("");
  const double ours = cost(times[0], options.threads);
  const double theirs = llvmpipe ? cost(times[1], options.threads) : none;
  const double rays = embree ? cost(times.back(), options.threads) : none;
  const double target = options.threads == 1 && entry.times_llvmpipe > 0 ? entry.times_llvmpipe : none;
  table.add({entry.name,
             Cell::whole(stage.surfaces.primitive_count()),
             {ours, 2},
             {times[0].wall, 2},
             {theirs, 1},
             {theirs / ours, 1},
             {target, 1},
             {rays, 1},
             {rays / ours, 1}});
}

}  // namespace

Table measure_peers(const Options& options) {
  Table table(std::string("peers, threads: ").append(std::to_string(options.threads)),
              {"scene", "triangles", "ms", "wall ms", "llvmpipe", "times", "target", "Embree", "times E"});
  for (const SceneEntry& entry : scene_entries())
    if (options.wants_scene(entry)) measure(entry, options, table);
  return table;
}

}  // namespace frontmost::bench
