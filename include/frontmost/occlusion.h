// SPDX-License-Identifier: Apache-2.0
// Occlusion culling: which objects need not be drawn, with a proof.
//
//        eye                          A wall that lies wholly nearer than B and covers all of B's rectangle on the
//         .                           screen hides B, whatever B looks like. C looks over the wall, so it may be seen.
//        / \        ____
//       /===\ wall | B  |             Where the wall's triangles are is known for whole cells of the screen, not for
//      /     \     |____| ____        points: a cell counts as covered when a point of it is, and no edge at which the
//     /       \          | C  |       wall ends comes near it. So what is said to be hidden is hidden between the
//                                     samples of every picture, too.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// What is known of an object without drawing it.
enum class ObjectSight : std::uint8_t {
  outside,      ///< no part of it is within the viewing volume, or it has no finite triangle
  hidden,       ///< no point of it is seen from the eye within the picture; certain
  may_be_seen,  ///< nothing is known to hide it
};

/// What culling takes for an object.
enum class ObjectUnit : std::uint8_t {
  instances,  ///< an Instance of the scene
  parts,      ///< what of an instance hangs together by its vertices' places: for scenes of few, large meshes
  clusters,   ///< up to 128 neighbouring triangles of an instance: for single large meshes that hang together
};

/// Triangles of one instance that are culled together.
struct CulledObject {
  std::uint32_t instance = no_index;
  std::uint32_t part = 0;  ///< part of the mesh, in the order of their first triangles, or cluster; counted from 0
};

struct OcclusionOptions {
  /// The sides of a cell of the screen, in pixels, 1 to 64: smaller cells find more that is hidden and cost more time.
  int cell = 2;
};

/// Finds out for many views of the same surfaces what is certainly hidden. Objects are visited from the eye outwards;
/// an object that may be seen covers cells as soon as what is visited lies behind it.
/// Triangles whose material is of alpha mode MASK, or may be seen through (Material::is_see_through()), hide nothing.
/// Made once; each call uses the memory of the last. What Surfaces::move() moves is followed by itself. Not for several
/// threads at once.
class Occlusion {
 public:
  /// Borrows the surfaces and their scene. O(triangles of meshes), about 65 bytes a triangle of a mesh.
  explicit Occlusion(const Surfaces& surfaces, ObjectUnit unit = ObjectUnit::instances,
                     const Execution& execution = {});
  ~Occlusion();
  Occlusion(Occlusion&&) noexcept;
  Occlusion& operator=(Occlusion&&) noexcept;
  Occlusion(const Occlusion&) = delete;
  Occlusion& operator=(const Occlusion&) = delete;

  [[nodiscard]] std::size_t object_count() const;
  /// Precondition: number < object_count(). Instances come in the order of the scene, their parts one after another.
  [[nodiscard]] CulledObject object(std::size_t number) const;

  /// Its triangles, by their numbers in the mesh: those with finite corners. Precondition: number < object_count().
  [[nodiscard]] std::span<const std::uint32_t> triangles(std::size_t number) const;

  /// For every object what is known of it in this view; the answer stays as it is until the next call.
  /// Culling of faces counts: faces that are left out hide nothing. The same for all instruction sets.
  /// Objects are in groups that are hidden or outside as a whole, so that many of these cost little; at worst
  /// O(objects + triangles of what may be seen).
  /// \throws Error bad_argument as validate(view) does, and for a cell out of range.
  std::span<const ObjectSight> cull(const View& view, const OcclusionOptions& options = {},
                                    const Execution& execution = {}) &;
  /// What is known, in the view of the last cull(), of something within a box of the world: a thing that is not in the
  /// scene, or one that has moved. Before the first call, and of boxes that are empty or have NaN: outside. O(cells
  /// that the box covers / 512).
  [[nodiscard]] ObjectSight sight_of(const Box& box) const;
  /// The same of many. Precondition: as many of both. Allocates nothing from the second call on.
  void find_sights(std::span<const Box> boxes, std::span<ObjectSight> sights) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost
