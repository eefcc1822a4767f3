// SPDX-License-Identifier: Apache-2.0
// The only pass over all triangles of a scene before anything is drawn: it checks their vertices and finds their boxes
// and sides. So later steps need not check again, and can leave out triangles behind or beside the picture.
#include "surfaces/placed_scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "scene/validate.h"
#include "surfaces/material_sides.h"

namespace frontmost {
namespace {

/// Lists the ranges of all instances; their vertices are found later.
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

/// Whether a mesh without an instance, which no range covers, has bad vertex numbers.
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
        throw Error(
            ErrorCode::bad_argument,
            place_in(scene) + "instance " + std::to_string(instance) + " (" + scene.instances[instance].name + ")",
            "its transform is not finite");
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
        find_boxes(world_triangles(placed, range, execution.isa, scratch), execution.isa,
                   &placed.boxes[range.first_box]);
      else
        is_bad = true;
    }
  });
  if (is_bad) validate(scene);  // validate() reports the error
  placed.instance_bounds.resize(scene.instances.size());
  for (const MeshRange& range : placed.ranges)
    for (std::uint32_t k = 0; k < range.box_count(); ++k)
      placed.instance_bounds[range.instance].include(placed.boxes[range.first_box + k]);
  placed.find_bounds();
  placed.cutouts = Cutouts::of(scene, placed.first_primitives);
  placed.sides = MaterialSides::of(scene, placed.first_primitives);
  report_progress(execution, "surfaces", 1);
  return placed;
}

namespace {

/// \returns room for `count` positions, whose contents are left over from earlier use. The scratch memory only grows.
std::span<glm::vec3> room_for(std::size_t count, WorldScratch& scratch) {
  if (scratch.positions.size() < count) scratch.positions.resize(count);
  return std::span(scratch.positions).first(count);
}

/// Gathers the vertices of triangles, each once, in the order of their first use.
std::span<glm::vec3> gather_vertices(std::span<const glm::uvec3> corners, const std::vector<glm::vec3>& positions,
                                     const NumberRange& numbers, WorldScratch& scratch) {
  const std::span<glm::vec3> room = room_for(3 * corners.size(), scratch);
  std::vector<std::uint32_t>& known = scratch.known;
  const std::size_t span = std::size_t(numbers.high - numbers.low) + 1;
  if (known.size() < span) known.resize(span, 0);
  if (scratch.known_from > no_index - room.size()) {
    std::fill(known.begin(), known.end(), 0);
    scratch.known_from = 1;
  }
  const std::uint32_t from = scratch.known_from;
  std::uint32_t next = from;
  scratch.corners.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      // The vertex is written whether it is new or not, because a branch would be unpredictable.
      std::uint32_t& place = known[corners[i][k] - numbers.low];
      const bool is_new = place < from;
      room[next - from] = positions[corners[i][k]];
      place = is_new ? next : place;
      next += is_new;
      scratch.corners[i][k] = place - from;
    }
  scratch.known_from = next;
  return room.first(next - from);
}

}  // namespace

WorldTriangles world_triangles(const PlacedScene& placed, const MeshRange& range, Isa isa, WorldScratch& scratch) {
  const glm::dmat4& world_from_mesh = placed.scene->instances[range.instance].world_from_mesh;
  const bool is_identity = ToWorld(world_from_mesh).is_identity();
  const std::vector<glm::vec3>& positions = placed.mesh(range).positions;
  WorldTriangles triangles;
  triangles.corners = placed.corners(range);
  triangles.is_mirrored = placed.mirrored[range.instance] != 0;
  triangles.first_id = placed.first_id(range);
  if (range.vertices.is_dense(range.count())) {
    const auto [low, high] = range.vertices;
    triangles.positions = std::span(positions).subspan(low, std::size_t(high - low) + 1);
    triangles.first_position = low;
    // Most files have one instance without a transform, which needs no copy.
    if (is_identity) return triangles;
    const std::span<glm::vec3> world = room_for(triangles.positions.size(), scratch);
    place_vertices(world_from_mesh, triangles.positions, world.data(), isa);
    triangles.positions = world;
    return triangles;
  }
  const std::span<glm::vec3> gathered = gather_vertices(triangles.corners, positions, range.vertices, scratch);
  if (!is_identity) place_vertices(world_from_mesh, gathered, gathered.data(), isa);
  triangles.corners = scratch.corners;
  triangles.positions = gathered;
  return triangles;
}

namespace {

/// Whether triangles of a mesh, or of several meshes, have double-sided materials, and whether any have single-sided
/// ones.
struct SidesFound {
  bool is_any_double = false, is_any_single = false;

  [[nodiscard]] bool are_mixed() const { return is_any_double && is_any_single; }
};

SidesFound sides_of(const Scene& scene, const Mesh& mesh) {
  SidesFound found;
  const auto add = [&](std::uint32_t material) {
    (is_double_sided(scene, material) ? found.is_any_double : found.is_any_single) = true;
  };
  if (mesh.triangles.empty()) return found;
  if (mesh.material_ids.size() <= 1) add(mesh.material_of(0));
  for (std::size_t i = 0; mesh.material_ids.size() > 1 && i < mesh.material_ids.size() && !found.are_mixed(); ++i)
    add(mesh.material_ids[i]);
  return found;
}

}  // namespace

bool is_double_sided(const Scene& scene, std::uint32_t material) {
  return material < scene.materials.size() && scene.materials[material].double_sided;
}

std::shared_ptr<const MaterialSides> MaterialSides::of(const Scene& scene,
                                                       const std::vector<PrimitiveId>& first_primitives) {
  const auto sides = std::make_shared<MaterialSides>();
  const auto is_double = [](const Material& material) { return material.double_sided; };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), is_double)) return sides;
  std::vector<SidesFound> of_meshes;
  of_meshes.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) of_meshes.push_back(sides_of(scene, mesh));
  SidesFound all;
  for (const Instance& instance : scene.instances) {
    all.is_any_double |= of_meshes[instance.mesh].is_any_double;
    all.is_any_single |= of_meshes[instance.mesh].is_any_single;
  }
  sides->are_all_double = all.is_any_double && !all.is_any_single;
  if (!all.are_mixed()) return sides;
  sides->bits.assign(std::size_t(first_primitives.back()) / 32 + 1, 0);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    const SidesFound& found = of_meshes[scene.instances[i].mesh];
    PrimitiveId id = first_primitives[i];
    for (std::uint32_t t = 0; found.is_any_double && t < mesh.triangles.size(); ++t, ++id)
      if (!found.is_any_single || is_double_sided(scene, mesh.material_of(t)))
        sides->bits[id / 32] |= std::uint32_t(1) << (id % 32);
  }
  return sides;
}

}  // namespace frontmost
