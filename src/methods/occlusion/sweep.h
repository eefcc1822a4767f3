// SPDX-License-Identifier: Apache-2.0
// The order in which objects are visited: from the eye outwards, by the nearest distance of their boxes.
//
//    distance ->   0      1      2      3      4      5      6         ranges of distances, by number
//    object A             [======]                                    tested in 1, covers from 3 on
//    object B                           [=============]               tested in 3 against A, covers from 6 on
//    object C                                  [====================  long: its triangles cover slab by slab
//
// What covers lies in ranges before those of what is tested against it, so that it is nearer for certain. Within a
// range nothing depends on the order.
//
// Groups of objects are visited as objects are, in the range of their nearest distance: what is hidden or outside is so
// as a whole, and of any other the items are lined up, none of which is nearer.
//
// A test asks about the object's box first, which takes ten nanoseconds. Where that is not covered, the cells that the
// object's own triangles come near are found; these same cells, without its ends, are what it covers later.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "frontmost/occlusion.h"
#include "occlusion/long_object.h"
#include "occlusion/object_tree.h"

namespace frontmost::occlusion_detail {

/// What is swept over.
struct SweptScene {
  const Scene& scene;
  std::span<const OccluderMesh> meshes;  ///< by mesh
  std::span<const CulledObject> objects;
  const ObjectTree& tree;
  std::span<const std::uint8_t> mirrored;  ///< by instance
};

/// A view of it.
struct SweptView {
  const CellGrid& grid;
  Culling culling;
  Isa isa;
};

/// One sweep after another in the same memory.
class Sweep {
 public:
  /// Sets `sights`, and leaves what is covered in `cover`.
  void run(const SweptScene& scene, const SweptView& view, std::span<ObjectSight> sights, CellCover& cover);

 private:
  /// Something that covers from a range on: an object whose cells are known, or a slab of a long one. `next` is the
  /// following event of that range.
  struct Event {
    std::uint32_t item;  ///< an object
    std::uint32_t long_object = no_index;
    int slab = 0;
    std::size_t first_row = 0;  ///< within solid_
    std::uint32_t next = no_index;
  };
  class Run;

  std::vector<ScreenBox> boxes_;                       ///< by item, once it is lined up
  std::vector<std::uint32_t> first_test_, next_test_;  ///< lists of items by range
  std::vector<std::uint32_t> first_event_;             ///< by range
  std::vector<Event> events_;
  std::vector<std::unique_ptr<LongObject>> long_objects_;
  OccluderOnScreen on_screen_;
  CoverScratch scratch_;
  std::vector<std::uint32_t> solid_;  ///< cells of objects that are to cover
};

}  // namespace frontmost::occlusion_detail
