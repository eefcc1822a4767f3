// SPDX-License-Identifier: Apache-2.0
// The one look at every triangle that a scene gets before anything is drawn: its corners are checked and put into
// boxes. So what comes later need not check again, and may leave out what is behind or beside the picture.

#include "surfaces/placed_scene.h"

#include <atomic>
#include <cmath>

#include "base/parallel.h"

namespace frontmost {
namespace {

/// The ranges of all instances; their vertices are still to be found.
void list_ranges(PlacedScene& placed) {
  std::uint32_t box_count = 0;
  for (std::uint32_t i = 0; i < placed.scene->instances.size(); ++i) {
    const std::uint32_t count = placed.first_primitives[i + 1] - placed.first_primitives[i];
    for (std::uint32_t begin = 0; begin < count;) {
      const std::uint32_t size = std::min(count - begin, MeshRange::most_triangles);
      placed.ranges.push_back({i, begin, begin + size, {}, box_count});
      box_count += placed.ranges.back().box_count();
      begin += size;
    }
  }
  placed.boxes.resize(box_count);
}

/// What no range of an instance has looked at.
bool has_bad_unplaced_mesh(const Scene& scene, Isa isa) {
  std::vector<bool> is_placed(scene.meshes.size(), false);
  for (const Instance& instance : scene.instances) is_placed[instance.mesh] = true;
  for (std::size_t m = 0; m < is_placed.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    if (is_placed[m] || mesh.triangles.empty()) continue;
    if (range_of_numbers(mesh.triangles, isa).high >= mesh.positions.size()) return true;
  }
  return false;
}

}  // namespace

void check_transform(const Scene& scene, std::size_t instance, const glm::dmat4& world_from_mesh) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(world_from_mesh[column][row]))
        throw Error(ErrorCode::bad_argument, scene.name + ": instance " + std::to_string(instance) + " (" +
                                                 scene.instances[instance].name + "): its transform is not finite");
}

void check_transforms(const Scene& scene) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    check_transform(scene, i, scene.instances[i].world_from_mesh);
}

PlacedScene place_scene(const Scene& scene, const Execution& execution) {
  constexpr std::size_t kRangesAtOnce = 16;
  PlacedScene placed;
  placed.scene = &scene;
  placed.first_primitives.push_back(0);
  for (const Instance& instance : scene.instances) {
    placed.first_primitives.push_back(placed.first_primitives.back() +
                                      static_cast<PrimitiveId>(scene.meshes[instance.mesh].triangles.size()));
    placed.mirrored.push_back(mirrors(instance.world_from_mesh));
  }
  list_ranges(placed);
  std::atomic<bool> is_bad{has_bad_unplaced_mesh(scene, execution.isa)};
  parallel_for(execution, placed.ranges.size(), kRangesAtOnce, [&](std::size_t begin, std::size_t end) {
    WorldScratch scratch;
    for (std::size_t i = begin; i < end && !is_bad; ++i) {
      MeshRange& range = placed.ranges[i];
      range.vertices = range_of_numbers(placed.corners(range), execution.isa);
      if (range.vertices.high < placed.mesh(range).positions.size())
        find_boxes(world_triangles(placed, range, scratch), execution.isa, &placed.boxes[range.first_box]);
      else
        is_bad = true;
    }
  });
  if (is_bad) validate(scene);  // says what is wrong
  placed.instance_bounds.resize(scene.instances.size());
  for (const MeshRange& range : placed.ranges)
    for (std::uint32_t k = 0; k < range.box_count(); ++k)
      placed.instance_bounds[range.instance].include(placed.boxes[range.first_box + k]);
  for (const Box& box : placed.instance_bounds) placed.bounds.include(box);
  placed.cutouts = Cutouts::of(scene, placed.first_primitives);
  report_progress(execution, "surfaces", 1);
  return placed;
}

WorldTriangles world_triangles(const PlacedScene& placed, const MeshRange& range, WorldScratch& scratch) {
  const ToWorld world(placed.scene->instances[range.instance].world_from_mesh);
  const std::vector<glm::vec3>& positions = placed.mesh(range).positions;
  WorldTriangles triangles;
  triangles.corners = placed.corners(range);
  triangles.is_mirrored = placed.mirrored[range.instance] != 0;
  triangles.first_id = placed.first_id(range);
  scratch.positions.clear();
  if (range.vertices.is_dense(range.count())) {
    const auto [low, high] = range.vertices;
    const auto dense = std::span(positions).subspan(low, std::size_t(high - low) + 1);
    triangles.first_position = low;
    // No copy at all: most files have one instance, where it is.
    if (!world.is_identity())
      for (const glm::vec3& p : dense) scratch.positions.push_back(world(p));
    triangles.positions = world.is_identity() ? dense : scratch.positions;
    return triangles;
  }
  scratch.corners.clear();
  for (const glm::uvec3& c : triangles.corners) {
    const auto n = std::uint32_t(scratch.positions.size());
    scratch.corners.emplace_back(n, n + 1, n + 2);
    for (int k = 0; k < 3; ++k) scratch.positions.push_back(world(positions[c[k]]));
  }
  triangles.corners = scratch.corners;
  triangles.positions = scratch.positions;
  return triangles;
}

}  // namespace frontmost
