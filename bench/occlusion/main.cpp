// SPDX-License-Identifier: Apache-2.0
// occlusion_table [--rounds N] [MODEL...] : culling of ten thousand houses, and of models seen from a corner of each,
// beside Masked Occlusion Culling; boxes against the covered cells; one moving house of ten thousand; and a million
// houses. All run on one thread and take turns; the least time of all rounds counts.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>
#include <random>

#include "harness/scenes.h"
#include "harness/table.h"
#include "occlusion/masked_peer.h"

namespace frontmost::bench {
namespace {

int rounds = 200;

/// Least time of each contestant in milliseconds; the contestants take turns.
std::vector<double> least_times(const std::vector<std::function<void()>>& contestants) {
  std::vector<double> least(contestants.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      const auto start = std::chrono::steady_clock::now();
      contestants[i]();
      const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
      least[i] = std::min(least[i], time.count());
    }
  return least;
}

struct Row {
  std::string name;
  const Surfaces& surfaces;
  View view;
  bool is_closed;
};

/// For each object, whether sixteen samples a pixel show it.
std::vector<std::uint8_t> found_by_samples(const Row& row) {
  View view = row.view;
  view.samples = 16;
  view.culling = row.is_closed ? Culling::back : Culling::none;
  const Visible visible = zbuffer(row.surfaces, view);
  std::vector<std::uint8_t> found(row.surfaces.scene().instances.size(), 0);
  for (const PrimitiveId id : visible.primitives)
    if (id != no_primitive) found[row.surfaces.source(id).instance] = 1;
  return found;
}

void measure(const Row& row, Table& table) {
  Occlusion occlusion(row.surfaces);
  View view = row.view;
  view.culling = row.is_closed ? Culling::back : Culling::none;
  const auto cull = [&](Isa isa) {
    return [&, isa] { static_cast<void>(occlusion.cull(view, {.cell = 1}, {.threads = 1, .isa = isa})); };
  };
  std::vector<std::function<void()>> contestants{cull(Isa::best)};
  const auto isas = available_isas();
  const bool has_avx2 = std::find(isas.begin(), isas.end(), Isa::avx2) != isas.end();
  if (has_avx2) contestants.push_back(cull(Isa::avx2));
  const auto peer = make_masked_peer(row.surfaces, view, row.is_closed);
  if (peer) contestants.push_back([&] { peer->cull(); });
  const std::vector<double> times = least_times(contestants);
  const auto found = found_by_samples(row);
  const auto sights = occlusion.cull(view, {.cell = 1});
  std::size_t seen = 0, true_count = 0, peers = 0, peer_wrong = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    seen += sights[i] == ObjectSight::may_be_seen;
    true_count += found[i];
    if (found[i] && sights[i] != ObjectSight::may_be_seen) table.fail();
    if (peer) peers += peer->seen()[i], peer_wrong += found[i] && !peer->seen()[i];
  }
  const double none = std::nan("");
  table.add({row.name,
             Cell::whole(found.size()),
             Cell::whole(true_count),
             Cell::whole(seen),
             {times[0], 3},
             {has_avx2 ? times[1] : none, 3},
             {peer ? double(peers) : none, 0},
             {peer ? times.back() : none, 3},
             {peer ? double(peer_wrong) : none, 0}});
}

/// Tests boxes against the cells that the last view covered.
void measure_boxes(const Row& row) {
  Occlusion occlusion(row.surfaces);
  static_cast<void>(occlusion.cull(row.view, {.cell = 1}));
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < row.surfaces.scene().instances.size(); ++i) boxes.push_back(row.surfaces.bounds(i));
  std::vector<ObjectSight> sights(boxes.size());
  const double ms = least_times({[&] { occlusion.find_sights(boxes, sights); }})[0];
  std::printf("%s: %.1f million boxes a second\n", row.name.c_str(), double(boxes.size()) / ms / 1000);
}

/// Moves one of many objects, and updates all kept structures.
void measure_move(Scene scene, const View& view) {
  Surfaces surfaces(scene);
  RayIndex index(surfaces);
  Occlusion occlusion(surfaces);
  ZBuffer buffer;
  static_cast<void>(buffer.draw(surfaces, view));
  static_cast<void>(occlusion.cull(view, {.cell = 1}));
  glm::dmat4 place(1.0);
  const auto move = [&] {
    place[3].x += 0.001;
    surfaces.move(scene, 5000, place);
    index.follow(surfaces, 5000);
  };
  const auto make_anew = [&] {
    const Surfaces anew(scene);
    anew.make_clusters();
    const RayIndex anew_index(anew);
    const Occlusion anew_occlusion(anew);
  };
  const std::vector<double> times = least_times({move, make_anew});
  std::printf("one of %zu objects moves: %.4f ms; all made anew: %.1f ms\n", scene.instances.size(), times[0],
              times[1]);
}

/// A city of separate instances of one house.
Scene placed_city(const Mesh& house, int side) {
  Scene city;
  city.meshes.push_back(house);
  Box cube;
  for (const glm::vec3& corner : house.positions) cube.include(corner);
  std::mt19937 numbers(11);
  const auto unit = [&] { return double(numbers()) / 4294967296.0; };
  for (int i = 0; i < side * side; ++i) {
    const double height = 1 + 5 * unit() * unit(), width = 0.4 + 0.4 * unit(), depth = 0.4 + 0.4 * unit();
    const glm::dvec3 size(width, height, depth), place(i % side, height / 2, i / side);
    glm::dmat4 at(1.0);
    for (int axis = 0; axis < 3; ++axis) at[axis][axis] = size[axis] / double(cube.high[axis] - cube.low[axis]);
    at[3] = glm::dvec4(place - glm::dvec3(at * glm::dvec4(cube.centre(), 0)), 1);
    city.instances.push_back({"", 0, at});
  }
  return city;
}

/// \returns whether no object that a sample finds is hidden.
bool measure_many(const Mesh& house, int side) {
  const Scene city = placed_city(house, side);
  const Surfaces surfaces(city);
  Occlusion occlusion(surfaces);
  const glm::dvec3 from_above(side / 2, 4, side + 4), in_street(side / 2 + 0.5, 0.5, side / 2 + 0.5);
  const auto measure_from = [&](const char* name, const glm::dvec3& eye, const glm::dvec3& to) {
    const View view =
        frontmost::make_view(1.0, 1920, 1080).looking(eye, eye + to, {0, 1, 0}).enclosing(surfaces.bounds());
    const auto cull = [&] { static_cast<void>(occlusion.cull(view, {.cell = 1}, {.threads = 1})); };
    const double ms = least_times({cull})[0];
    const auto sights = occlusion.cull(view, {.cell = 1});
    std::size_t counts[3] = {}, wrong = 0;
    for (const ObjectSight sight : sights) ++counts[std::size_t(sight)];
    for (const PrimitiveId id : zbuffer(surfaces, view).primitives)
      wrong += id != no_primitive && sights[surfaces.source(id).instance] != ObjectSight::may_be_seen;
    std::printf("%zu houses %s, 1920x1080: %zu outside, %zu hidden, %zu may be seen, %zu samples wrong, %.3f ms\n",
                sights.size(), name, counts[0], counts[1], counts[2], wrong, ms);
    return wrong == 0;
  };
  const bool is_right = measure_from("flown over", from_above, {0, -4, -44});
  return measure_from("from a street", in_street, {-1.5, -0.1, -8.5}) && is_right;
}

View resized(View view, int width, int height) {
  view.width = width, view.height = height;
  return view;
}

int run(int count, char** arguments) {
  std::vector<std::string> models;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(arguments[i], "--rounds") == 0 && i + 1 < count)
      rounds = std::max(1, std::atoi(arguments[++i]));
    else
      models.emplace_back(arguments[i]);
  }
  const Scene whole = make_scene("city", "");
  const Scene city = taken_apart(whole);
  const Surfaces surfaces(city);
  const View view = make_view(surfaces.bounds(), Camera::in_city);
  Table table("occlusion culling, cells of a pixel",
              {"scene", "objects", "true", "seen", "ms", "ms AVX2", "masked seen", "masked ms", "masked wrong"});
  measure({"city 480x270", surfaces, resized(view, 480, 270), true}, table);
  measure({"city 1920x1080", surfaces, view, true}, table);
  for (const std::string& model : models) {
    const Scene scene = load(model);
    const Surfaces own(scene);
    const Box& box = own.bounds();
    const glm::dvec3 low(box.low), size = glm::dvec3(box.high) - low;
    const View inside = frontmost::make_view(1.0, 640, 480)
                            .looking(low + size * glm::dvec3(0.1, 0.6, 0.1), low + size * glm::dvec3(0.9, 0.3, 0.9),
                                     direction(scene.up))
                            .enclosing(box);
    const std::string name = model.substr(model.rfind('/') + 1);
    measure({name + " 640x480", own, inside, false}, table);
  }
  measure_boxes({"city 480x270", surfaces, resized(view, 480, 270), true});
  measure_boxes({"city 1920x1080", surfaces, view, true});
  measure_move(city, view);
  const bool is_right = measure_many(city.meshes[0], 450) && measure_many(city.meshes[0], 1000);
  return table.holds() && is_right ? 0 : 1;
}

}  // namespace
}  // namespace frontmost::bench

int main(int count, char** arguments) try {
  return frontmost::bench::run(count, arguments);
} catch (const frontmost::Error& error) {
  std::fprintf(stderr, "occlusion_table: %s\n", error.what());
  return 1;
}
