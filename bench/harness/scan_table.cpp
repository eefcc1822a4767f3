// SPDX-License-Identifier: Apache-2.0
// Scans from inside a model: rays in packets and the same rays one by one, in turn.
#include <frontmost/files.h>
#include <frontmost/raycast.h>

#include <filesystem>

#include "harness/measure.h"
#include "harness/tables.h"

namespace frontmost::bench {
namespace {

constexpr double kTurn = 6.28318530717958647692;

/// Cuts every triangle into steps * steps similar ones.
Scene finer(const Scene& scene, int steps) {
  Scene result;
  for (const Mesh& from : scene.meshes) {
    Mesh& to = result.meshes.emplace_back();
    for (const glm::uvec3& t : from.triangles) {
      const glm::vec3 a = from.positions[t.x], u = (from.positions[t.y] - a) / float(steps),
                      v = (from.positions[t.z] - a) / float(steps);
      const auto first = std::uint32_t(to.positions.size());
      const auto at = [&](int i, int k) { return first + std::uint32_t(i * (steps + 1) - i * (i - 1) / 2 + k); };
      for (int i = 0; i <= steps; ++i)
        for (int k = 0; k <= steps - i; ++k) to.positions.push_back(a + float(i) * u + float(k) * v);
      for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps - i; ++k) {
          to.triangles.emplace_back(at(i, k), at(i + 1, k), at(i, k + 1));
          if (k + 1 < steps - i) to.triangles.emplace_back(at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
        }
    }
  }
  for (const Instance& instance : scene.instances)
    result.instances.push_back({"", instance.mesh, instance.world_from_mesh});
  return result;
}

std::vector<Ray> rays_of(const RayCamera& camera) {
  const glm::ivec2 grid = grid_of(camera);
  std::vector<Ray> rays;
  for (int y = 0; y < grid.y; ++y)
    for (int x = 0; x < grid.x; ++x) rays.push_back(ray_of(camera, x, y));
  return rays;
}

/// Measures scans of one model from the middle of its box.
void measure(const char* name, const Scene& scene, const Options& options, Table& table) {
  const Surfaces surfaces(scene);
  const RayIndex index(surfaces);
  const glm::dvec3 eye(surfaces.bounds().centre());
  const glm::dmat4 pose = look_at(eye, eye + glm::dvec3(1, 0, 0.2), {0, 1, 0});
  const struct {
    const char* name;
    RayCamera camera;
  } cameras[] = {{"laser, 64 x 2048", {Lidar{ring_elevations(64, -kTurn / 14, kTurn / 24), 2048}, pose}},
                 {"laser, 16 x 1024", {Lidar{ring_elevations(16, -kTurn / 24, kTurn / 24), 1024}, pose}},
                 {"panorama, 1024 x 512", {Panorama{1024, 512}, pose}},
                 {"fisheye, 512 x 512", {Fisheye{512, 512}, pose}}};
  for (const auto& kind : cameras) {
    const RayCamera& camera = kind.camera;
    const std::vector<Ray> rays = rays_of(camera);
    std::vector<RayHit> hits(rays.size());
    const std::vector<Time> times = race({Contestant([&] { (void)scan(index, camera, {.threads = 1}); }),
                                          Contestant([&] { closest_hits(index, rays, hits, {.threads = 1}); })},
                                         options.sampling);
    const auto million = [&](std::size_t i) { return double(rays.size()) / times[i].processor * 1e-3; };
    table.add({std::string(name),
               kind.name,
               Cell::whole(surfaces.primitive_count()),
               {million(0)},
               {million(1)},
               {million(0) / million(1), 1}});
  }
}

}  // namespace

Table measure_scans(const Options& options) {
  Table table("scans from inside, million rays a second, one thread",
              {"model", "rays", "triangles", "scan", "one by one", "times"});
  const std::string folder = options.models + "/scenes/";
  const auto wants = [&](const char* file) { return std::filesystem::exists(folder + file); };
  if (wants("home-theater.glb")) {
    const Scene room = load(folder + "home-theater.glb");
    measure("home-theater", room, options, table);
    measure("home-theater, cut finer", finer(room, 6), options, table);
  }
  if (wants("sponza.glb")) measure("sponza", load(folder + "sponza.glb"), options, table);
  return table;
}

}  // namespace frontmost::bench
