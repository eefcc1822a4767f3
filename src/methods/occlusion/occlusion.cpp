// SPDX-License-Identifier: Apache-2.0
// Occlusion: makes objects, their meshes and their tree, culls views, and answers queries for boxes.
#include "frontmost/occlusion.h"

#include <algorithm>
#include <optional>

#include "base/parallel.h"
#include "occlusion/sweep.h"

namespace frontmost {
namespace {

using namespace occlusion_detail;

/// Returns a box that contains the transformed `box`. Positions are rounded like vertices.
Box world_box(const glm::dmat4& world_from_mesh, const Box& box) {
  Box world;
  if (box.is_empty()) return world;
  const ToWorld to_world(world_from_mesh);
  for (int corner = 0; corner < 8; ++corner)
    world.include(to_world(glm::vec3(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                     corner & 4 ? box.high.z : box.low.z)));
  return world;
}

}  // namespace

struct Occlusion::State {
  State(const Surfaces& its_surfaces, ObjectUnit its_unit, const Execution& execution)
      : surfaces(its_surfaces), unit(its_unit), moves(placed_scene(its_surfaces).moves.count()) {
    const Scene& scene = surfaces.scene();
    find_meshes(execution);
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      first_objects.push_back(std::uint32_t(objects.size()));
      const std::size_t parts = meshes[scene.instances[i].mesh].parts.size();
      for (std::uint32_t part = 0; part < parts; ++part) objects.push_back({i, part});
    }
    first_objects.push_back(std::uint32_t(objects.size()));
    make_tree();
    sights.resize(objects.size());
  }

  [[nodiscard]] Box box_of(const CulledObject& object) const {
    if (unit == ObjectUnit::instances) return surfaces.bounds(object.instance);
    const Instance& it = surfaces.scene().instances[object.instance];
    return world_box(it.world_from_mesh, meshes[it.mesh].parts[object.part].bounds);
  }

  void make_tree() {
    std::vector<Box> boxes;
    boxes.reserve(objects.size());
    for (const CulledObject& object : objects) boxes.push_back(box_of(object));
    tree = ObjectTree(boxes);
  }

  void follow_moves() {
    placed_scene(surfaces).moves.visit_since(moves, first_objects.size() - 1, [&](std::uint32_t instance) {
      for (std::uint32_t i = first_objects[instance]; i < first_objects[instance + 1]; ++i)
        tree.move(i, box_of(objects[i]));
    });
    tree.refit();
    if (tree.is_outdated()) make_tree();
  }

  void find_meshes(const Execution& execution) {
    const Scene& scene = surfaces.scene();
    meshes.resize(scene.meshes.size());
    std::vector<std::uint32_t> user(meshes.size(), no_index);
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
      if (user[scene.instances[i].mesh] == no_index) user[scene.instances[i].mesh] = i;
    parallel_for(execution, meshes.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t m = begin; m < end; ++m)
        if (user[m] != no_index) meshes[m] = occluder_mesh(placed_scene(surfaces), user[m], unit, execution);
    });
  }

  const Surfaces& surfaces;
  ObjectUnit unit;
  std::uint64_t moves;  ///< number of the surfaces' moves that the tree has followed
  std::vector<OccluderMesh> meshes;
  std::vector<CulledObject> objects;
  std::vector<std::uint32_t> first_objects;  ///< by instance; then the number of objects
  ObjectTree tree;

  // Result of the last view.
  std::optional<CellGrid> grid;
  std::vector<ObjectSight> sights;
  CellCover cover;
  // Boxes of queries, a block at a time.
  static constexpr std::size_t most_asked = 512;
  BoxColumns asked{most_asked};
  std::vector<ScreenBox> asked_on_screen = std::vector<ScreenBox>(most_asked);
  Isa isa = Isa::best;
  Sweep sweep;
};

Occlusion::Occlusion(const Surfaces& surfaces, ObjectUnit unit, const Execution& execution)
    : state_(std::make_unique<State>(surfaces, unit, execution)) {}
Occlusion::~Occlusion() = default;
Occlusion::Occlusion(Occlusion&&) noexcept = default;
Occlusion& Occlusion::operator=(Occlusion&&) noexcept = default;

std::size_t Occlusion::object_count() const { return state_->objects.size(); }
CulledObject Occlusion::object(std::size_t number) const { return state_->objects[number]; }

std::span<const std::uint32_t> Occlusion::triangles(std::size_t number) const {
  const CulledObject& object = state_->objects[number];
  return state_->meshes[state_->surfaces.scene().instances[object.instance].mesh].parts[object.part].own;
}

std::span<const ObjectSight> Occlusion::cull(const View& view, const OcclusionOptions& options,
                                             const Execution& execution) & {
  validate(view);
  if (options.cell < 1 || options.cell > 64)
    throw Error(ErrorCode::bad_argument, "occlusion", "a cell must be 1 to 64 pixels wide");
  const IeeeScope ieee;
  State& s = *state_;
  s.follow_moves();
  s.isa = execution.isa;
  s.grid.emplace(view, options.cell);
  const SweptScene swept{s.surfaces.scene(), s.meshes, s.objects, s.tree, placed_scene(s.surfaces).mirrored};
  s.sweep.run(swept, {*s.grid, view.culling, s.isa}, s.sights, s.cover);
  return s.sights;
}

ObjectSight Occlusion::sight_of(const Box& box) const {
  ObjectSight sight = ObjectSight::outside;
  find_sights({&box, 1}, {&sight, 1});
  return sight;
}

void Occlusion::find_sights(std::span<const Box> boxes, std::span<ObjectSight> sights) const {
  State& s = *state_;
  if (!s.grid) return std::fill(sights.begin(), sights.end(), ObjectSight::outside);
  for (std::size_t first = 0; first < boxes.size(); first += State::most_asked) {
    const std::span<const Box> block = boxes.subspan(first, std::min(boxes.size() - first, State::most_asked));
    for (std::size_t i = 0; i < block.size(); ++i) s.asked.set(i, block[i]);
    find_on_screen(*s.grid, s.asked, {0, std::uint32_t(block.size())}, s.asked_on_screen, s.isa);
    find_sights_of(s.cover, std::span(s.asked_on_screen).first(block.size()), &sights[first], s.isa);
  }
}

}  // namespace frontmost
