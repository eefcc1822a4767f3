// SPDX-License-Identifier: Apache-2.0
// Visits objects from the eye outwards, in the order of the nearest distances of their boxes.
//
//    distance ->   0      1      2      3      4      5      6         ranges of distances, by number
//    object A             [======]                                    tested in 1, covers from 3 on
//    object B                           [=============]               tested in 3 against A, covers from 6 on
//    object C                                  [====================  long: its triangles cover slab by slab
//
// An occluder lies in ranges before those of the objects that are tested against it, so it is certainly nearer. Within
// a range nothing depends on the order. Groups of objects are visited like objects, in the range of their nearest
// distance. The items of a group that is neither hidden nor outside are queued, as none of them is nearer.
#pragma once

#include <memory>
#include <span>

#include "frontmost/occlusion.h"
#include "occlusion/object_tree.h"
#include "occlusion/occluder.h"

namespace frontmost::occlusion_detail {

/// The scene of a sweep.
struct SweptScene {
  const Scene& scene;
  std::span<const OccluderMesh> meshes;  ///< by mesh
  std::span<const CulledObject> objects;
  const ObjectTree& tree;
  std::span<const std::uint8_t> mirrored;  ///< by instance
};

/// The view of a sweep.
struct SweptView {
  const CellGrid& grid;
  Culling culling;
  Isa isa;
};

/// Performs sweeps, and reuses its memory.
class Sweep {
 public:
  Sweep();
  ~Sweep();
  /// Sets `sights`, and leaves the cover in `cover`.
  void run(const SweptScene& scene, const SweptView& view, std::span<ObjectSight> sights, CellCover& cover);

 private:
  struct Memory;
  class Run;
  std::unique_ptr<Memory> memory_;
};

}  // namespace frontmost::occlusion_detail
