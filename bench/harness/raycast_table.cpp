// SPDX-License-Identifier: Apache-2.0
// Ray casting beside Embree, in this process and in turn: building the index, one view, single rays in all
// directions and in the order of pixels.
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

/// The view's rays through a grid of 400 x 250, row by row.
std::vector<Ray> make_coherent_rays(const View& view) {
  const Projection& p = view.projection;
  std::vector<Ray> rays;
  for (int y = 0; y < 250; ++y)
    for (int x = 0; x < 400; ++x) {
      const double right = p.left + (p.right - p.left) * (x + 0.5) / 400;
      const double up = p.top + (p.bottom - p.top) * (y + 0.5) / 250;
      rays.push_back({glm::vec3(view.eye()), glm::vec3(view.forward() + view.right() * right + view.up() * up)});
    }
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
  const std::vector<Ray> rays = make_rays(segments), coherent = make_coherent_rays(stage.view);
  std::vector<RayHit> hits(kRays);
  std::vector<std::uint8_t> clear(kRays);
  std::vector<Contestant> contestants{Contestant([&] { (void)RayIndex(stage.surfaces, execution); }),
                                      Contestant([&] { (void)caster.draw(index, stage.view, execution); }),
                                      Contestant([&] { closest_hits(index, rays, hits, {.threads = 1}); }),
                                      Contestant([&] { closest_hits(index, coherent, hits, {.threads = 1}); }),
                                      Contestant([&] { are_clear(index, segments, clear, {.threads = 1}); })};
  if (embree) {
    contestants.push_back(Contestant([&] { embree->rebuild(); }));
    contestants.push_back(Contestant([&] { embree->draw(); }));
    contestants.push_back(Contestant([&] { (void)embree->count_hits(rays); }));
    contestants.push_back(Contestant([&] { (void)embree->count_hits(coherent); }));
    contestants.push_back(Contestant([&] { (void)embree->count_blocked(segments); }));
  }
  const std::vector<Time> times = race(contestants, options.sampling);

  const auto ms = [&](std::size_t i) { return cost(times[i], i % 5 < 2 ? options.threads : 1); };
  const auto ratio = [&](std::size_t i) { return embree ? ms(i + 5) / ms(i) : std::nan(""); };
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
             {ratio(3), 2},
             {million(4)},
             {ratio(4), 2}});
}

}  // namespace

Table measure_raycast(const Options& options) {
  Table table(std::string("raycast, threads: ").append(std::to_string(options.threads)),
              {"scene", "triangles", "index", "times E", "bytes", "bytes E", "view", "times E", "Mrays/s", "times E",
               "in order", "times E", "Mclear/s", "times E"});
  for (const SceneEntry& entry : scene_entries())
    if (options.wants_scene(entry)) measure(entry, options, table);
  return table;
}

}  // namespace frontmost::bench
