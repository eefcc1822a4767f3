// SPDX-License-Identifier: Apache-2.0
// Culls instances by a plain loop, without groups: the reference for the tree.
#pragma once

#include "occlusion/sweep.h"

namespace frontmost::test {

enum class Ends { count, are_forgotten };

/// Culls each object by itself, however many there are. veto_test.cpp describes the effect of forgotten ends.
inline std::vector<ObjectSight> sights_by_hand(const Surfaces& surfaces, const View& view, int cell, Ends ends) {
  using namespace occlusion_detail;
  const Scene& scene = surfaces.scene();
  std::vector<OccluderMesh> meshes(scene.meshes.size());
  std::vector<CulledObject> objects;
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    OccluderMesh& mesh = meshes[scene.instances[i].mesh] =
        occluder_mesh(placed_scene(surfaces), i, ObjectUnit::instances);
    // Each edge's neighbour becomes the triangle itself, so that no edge counts as an end.
    if (ends == Ends::are_forgotten)
      for (std::uint32_t t = 0; t < mesh.neighbours.size(); ++t) mesh.neighbours[t] = glm::uvec3(t);
    objects.push_back({i, 0});
    boxes.push_back(surfaces.bounds(i));
  }
  const CellGrid grid(view, cell);
  std::vector<ObjectSight> sights(objects.size());
  CellCover cover;
  const ObjectTree tree(boxes, boxes.size());
  Sweep().run({scene, meshes, objects, tree, placed_scene(surfaces).mirrored}, {grid, view.culling, Isa::best}, sights,
              cover);
  return sights;
}

}  // namespace frontmost::test
