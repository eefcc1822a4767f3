// SPDX-License-Identifier: Apache-2.0
// Ray casting beside Embree, in this process and in turn: building the index, one view, and single rays in all
// directions.
#include <cmath>

#include "harness/random.h"
#include "harness/stage.h"
#include "harness/tables.h"
#include "peers/peer.h"

namespace frontmost::bench {
namespace {

constexpr std::size_t kRays = 100'000;

/// Segments between random points of the scene's box.
std::vector<Segment> make_segments(const Box& box) {
  Random random{1};
  const auto point = [&] {
    glm::vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = box.low[axis] + (box.high[axis] - box.low[axis]) * random.unit();
    return p;
  };
  std::vector<Segment> segments(kRays);
  for (Segment& segment : segments) segment = {point(), point()};
  return segments;
}

std::vector<Ray> make_rays(const std::vector<Segment>& segments) {
  std::vector<Ray> rays;
  for (const Segment& segment : segments) rays.push_back({segment.from, segment.to - segment.from});
  return rays;
}

void measure(const SceneEntry& entry, const Options& options, Table& table) {
  const Stage stage(entry.name, options.models);
  if (stage.surfaces.primitive_count() == 0) return;
  const Execution execution{.threads = options.threads};
  const std::unique_ptr<RayPeer> embree =
      options.embree ? make_embree({stage.scene, stage.view, options.threads}) : nullptr;
  const RayIndex index(stage.surfaces, execution);
  RayCaster caster;
  const std::vector<Segment> segments = make_segments(stage.surfaces.bounds());
  const std::vector<Ray> rays = make_rays(segments);
  std::vector<RayHit> hits(kRays);
  std::vector<std::uint8_t> clear(kRays);
  std::vector<Contestant> contestants{Contestant([&] { (void)RayIndex(stage.surfaces, execution); }),
                                      Contestant([&] { (void)caster.draw(index, stage.view, execution); }),
                                      Contestant([&] { closest_hits(index, rays, hits, {.threads = 1}); }),
                                      Contestant([&] { are_clear(index, segments, clear, {.threads = 1}); })};
  if (embree) {
    contestants.push_back(Contestant([&] { embree->rebuild(); }));
    contestants.push_back(Contestant([&] { embree->draw(); }));
    contestants.push_back(Contestant([&] { (void)embree->count_hits(rays); }));
    contestants.push_back(Contestant([&] { (void)embree->count_blocked(segments); }));
  }
  const std::vector<Time> times = race(contestants, options.sampling);

  const auto ms = [&](std::size_t i) { return cost(times[i], i % 4 < 2 ? options.threads : 1); };
  const auto ratio = [&](std::size_t i) { return embree ? ms(i + 4) / ms(i) : std::nan(""); };
  const auto million = [&](std::size_t i) { return double(kRays) / ms(i) * 1e-3; };
  const double triangles = double(stage.surfaces.primitive_count());
  table.add({entry.name,
             Cell::whole(stage.surfaces.primitive_count()),
             {ms(0)},
             {ratio(0), 1},
             {double(index.byte_count()) / triangles, 0},
             {embree ? double(embree->byte_count()) / triangles : std::nan(""), 0},
             {ms(1)},
             {ratio(1), 2},
             {million(2)},
             {ratio(2), 2},
             {million(3)},
             {ratio(3), 2}});
}

}  // namespace

Table measure_raycast(const Options& options) {
  Table table(std::string("raycast, threads: ").append(std::to_string(options.threads)),
              {"scene", "triangles", "index", "times E", "bytes", "bytes E", "view", "times E", "Mrays/s", "times E",
               "Mclear/s", "times E"});
  for (const SceneEntry& entry : scene_entries())
    if (options.wants_scene(entry)) measure(entry, options, table);
  return table;
}

}  // namespace frontmost::bench
