// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "abuffer/tables.h"
#include "harness/peer_process.h"
#include "peers/peer.h"

namespace frontmost::bench {
namespace {

/// Number of pixels with a channel that differs by more than 3/255, as every layer of peeling is rounded to 1/255.
std::size_t differing(const Image& ours, const std::vector<glm::vec4>& theirs) {
  constexpr float kMost = 3 / 255.0f;
  std::size_t count = 0;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    bool differs = false;
    for (int k = 0; k < 4; ++k)
      differs = differs || std::abs(ours.channels[std::size_t(k)].floats()[i] - theirs[i][k]) > kMost;
    count += differs;
  }
  return count;
}

/// Number of layers that depth peeling draws, and how far its picture differs from ours.
struct Comparison {
  int layers = 0;
  double differing = std::nan("");  ///< pixels in a million

  explicit Comparison(const Stage& stage) {
    const auto peer = make_peeling({stage.scene, stage.view, 1});
    if (!peer) return;
    peer->draw();
    layers = peer->layer_count();
    const Image ours = draw_layers(stage, {0, opacity_of_copies}, {.threads = 1});
    const double count = double(bench::differing(ours, peer->read()));
    differing = 1e6 * count / double(stage.view.pixel_count());
  }
};

void measure(std::string_view scene, const Options& options, Table& table) {
  // Allowed pixels in a million: llvmpipe snaps vertices to other places, which moves edges.
  constexpr double kMostDiffering = 2000;
  const Stage stage = make_lit(scene, options.models);
  const Execution execution{.threads = options.threads};
  std::vector<Contestant> contestants;
  const std::vector<int> sides = grids(options);
  for (const int grid : sides) {
    contestants.emplace_back([&, grid] { (void)draw_layers(stage, {grid, opacity_of_copies}, execution); });
    contestants.emplace_back([&, grid] {
      (void)abuffer(stage.surfaces, stage.view, {grid, opacity_of_copies}, execution);
    });
  }
  std::unique_ptr<PeerProcess> peer;
  if (options.llvmpipe)
    peer = std::make_unique<PeerProcess>(PeerRequest{"peeling", std::string(scene), options.threads, false}, options);
  const bool has_peer = peer && peer->is_present();
  if (has_peer) contestants.push_back(Contestant::elsewhere([&] { return peer->draw(); }));
  const std::vector<Time> times = race(contestants, options.sampling);
  const double peeling = has_peer ? cost(times.back(), options.threads) : std::nan("");
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const double ms = cost(times[2 * i], options.threads);
    table.add({scene,
               Cell::whole(stage.surfaces.primitive_count()),
               Cell::whole(unsigned(samples_of(sides[i]))),
               {ms},
               {peeling, 0},
               {peeling / ms, 1},
               {cost(times[2 * i + 1], options.threads)}});
  }
  if (!has_peer) return;
  const Comparison comparison(stage);
  table.add({std::string("  ").append(std::to_string(comparison.layers)).append(" layers; pixels of a million"),
             "",
             "that differ",
             {comparison.differing, 0}});
  if (comparison.differing > kMostDiffering) table.fail();
}

}  // namespace

Table measure_peeling(const Options& options) {
  Table table("beside depth peeling, threads: " + std::to_string(options.threads),
              {"scene", "triangles", "sub-samples", "ms", "peeling, ms", "times", "lists alone, ms"});
  for (const SceneEntry& entry : translucent_entries())
    if (options.wants_scene(entry)) measure(entry.name, options, table);
  return table;
}

}  // namespace frontmost::bench
