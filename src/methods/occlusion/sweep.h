// SPDX-License-Identifier: Apache-2.0
// Visits objects from the eye outwards, in the order of the nearest distances of their boxes.
//
//    distance ->   0      1      2      3      4      5      6         ranges of distances, by number
//    object A             [======]                                    tested in 1, covers from 3 on
//    object B                           [=============]               tested in 3 against A, covers from 6 on
//    object C                                  [====================  long: its triangles cover slab by slab
//
// An occluder lies in ranges before those of the objects that are tested against it, so it is certainly nearer. Within
// a range nothing depends on the order.
//
// Groups of objects are visited like objects, in the range of their nearest distance. A group that is hidden or outside
// is so as a whole. The items of any other group are queued, as none of them is nearer.
//
// A test begins with the object's box, which takes ten nanoseconds. If the box is not covered, the cells near the
// object's own triangles are found and tested. The same cells, without those that have ends, are the object's cover
// later.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "frontmost/occlusion.h"
#include "occlusion/long_object.h"
#include "occlusion/object_tree.h"

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
  /// Sets `sights`, and leaves the cover in `cover`.
  void run(const SweptScene& scene, const SweptView& view, std::span<ObjectSight> sights, CellCover& cover);

 private:
  /// A cover that starts at a range: an object with known cells, or a slab of a long object. `next` is the following
  /// event of that range.
  struct Event {
    std::uint32_t item;  ///< an object
    std::uint32_t long_object = no_index;
    int slab = 0;
    std::size_t first_row = 0;  ///< within solid_
    std::uint32_t next = no_index;
  };
  class Run;

  std::vector<ScreenBox> boxes_;                       ///< by item, once the item is queued
  std::vector<std::uint32_t> first_test_, next_test_;  ///< lists of items by range
  std::vector<std::uint32_t> first_event_;             ///< by range
  std::vector<Event> events_;
  std::vector<std::unique_ptr<LongObject>> long_objects_;
  OccluderOnScreen on_screen_;
  CoverScratch scratch_;
  std::vector<std::uint32_t> solid_;  ///< cells of objects that will cover
};

}  // namespace frontmost::occlusion_detail
