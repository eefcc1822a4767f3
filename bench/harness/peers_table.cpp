// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "harness/peer_process.h"
#include "harness/stage.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

/// The peers of one row, each in its process; null if a peer is not wanted or absent.
struct Peers {
  std::unique_ptr<PeerProcess> llvmpipe, llvmpipe_keeping, embree;

  Peers(const SceneEntry& entry, const Options& options) {
    const auto make = [&](const char* peer, bool wanted, bool keeps_memory) {
      if (!wanted) return std::unique_ptr<PeerProcess>();
      const PeerRequest request{peer, std::string(entry.name), options.threads, keeps_memory};
      auto process = std::make_unique<PeerProcess>(request, options);
      return process->is_present() ? std::move(process) : nullptr;
    };
    llvmpipe = make("llvmpipe", options.llvmpipe, false);
    llvmpipe_keeping = make("llvmpipe", options.llvmpipe, true);
    embree = make("embree", options.embree, false);
  }
};

void measure(const SceneEntry& entry, const Options& options, Table& table) {
  const Peers peers(entry, options);
  const Stage stage(entry.name, options.models), cover(make_cover(stage.view), stage.view);
  const Execution execution{.threads = options.threads};
  Frames frames(stage), others(stage);
  std::vector<Contestant> contestants{Contestant([&] { frames.draw(execution); }),
                                      // Planes hold another picture before each frame.
                                      Contestant([&] { others.draw(execution); }, [&] { others.draw_other(cover); })};
  const auto add = [&](const std::unique_ptr<PeerProcess>& peer) {
    if (peer) contestants.push_back(Contestant::elsewhere([&] { return peer->draw(); }));
    return peer ? contestants.size() - 1 : 0;
  };
  const std::size_t llvmpipe = add(peers.llvmpipe), keeping = add(peers.llvmpipe_keeping), embree = add(peers.embree);
  const std::vector<Time> times = race(contestants, options.sampling);

  const auto ms = [&](std::size_t i) { return cost(times[i], options.threads); };
  const auto peer_ms = [&](std::size_t i) { return i == 0 ? std::nan("") : ms(i); };
  const double target = options.threads == 1 && entry.times_llvmpipe > 0 ? entry.times_llvmpipe : std::nan("");
  table.add({entry.name,
             Cell::whole(stage.surfaces.primitive_count()),
             {ms(0)},
             {ms(1)},
             {peer_ms(llvmpipe), 1},
             {peer_ms(llvmpipe) / ms(0), 1},
             {target, 1},
             {peer_ms(keeping) / ms(0), 1},
             {peer_ms(embree), 1},
             {peer_ms(embree) / ms(0), 1}});
}

}  // namespace

Table measure_peers(const Options& options) {
  Table table(
      std::string("peers, threads: ").append(std::to_string(options.threads)),
      {"scene", "triangles", "ms", "after other", "llvmpipe", "times", "target", "keeping", "Embree", "times E"});
  for (const SceneEntry& entry : scene_entries())
    if (options.wants_scene(entry)) measure(entry, options, table);
  return table;
}

}  // namespace frontmost::bench
