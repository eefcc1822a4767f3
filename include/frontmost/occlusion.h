// SPDX-License-Identifier: Apache-2.0
// Occlusion culling: finds objects that need not be drawn, with certainty.
//
//        eye                          A wall that lies wholly nearer than B and covers B's whole rectangle on screen
//         .                           hides B, whatever B looks like. C looks over the wall, so it may be seen.
//        / \        ____
//       /===\ wall | B  |             The wall covers whole cells of the screen, not points. A cell is covered if a
//      /     \     |____| ____        point of it is and no edge at which the wall ends comes near it. So a hidden
//     /       \          | C  |       object is hidden in every picture, between the samples as well.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

/// The visibility of an object, as far as it is known without drawing the object.
enum class ObjectSight : std::uint8_t {
  outside,      ///< no part lies within the viewing volume, or no triangle is finite
  hidden,       ///< certain: no point is seen from the eye within the picture
  may_be_seen,  ///< nothing is known to hide it
};

/// The unit that culling treats as an object.
enum class ObjectUnit : std::uint8_t {
  instances,  ///< an Instance of the scene
  parts,      ///< part of an instance connected by vertex positions: for scenes of few, large meshes
  clusters,   ///< up to 128 neighbouring triangles of an instance: for single large, connected meshes
};

/// Triangles of one instance that are culled together.
struct CulledObject {
  std::uint32_t instance = no_index;
  std::uint32_t part = 0;  ///< part of the mesh, in the order of first triangles, or cluster; counted from 0
};

struct OcclusionOptions {
  /// Side length of a cell of the screen, in pixels, 1 to 64. Smaller cells find more hidden objects and take more
  /// time.
  int cell = 2;
};

/// Finds the objects that are certainly hidden, for many views of the same surfaces. Objects are visited from the eye
/// outwards. An object that may be seen covers cells from the moment when all objects that are still to be visited lie
/// behind it. Triangles whose material has alpha mode MASK or is see-through (Material::is_see_through()) hide nothing.
/// Each call reuses the memory of the last. Instances moved by Surfaces::move() are followed automatically. An
/// Occlusion serves one thread at a time.
class Occlusion {
 public:
  /// Borrows the surfaces and their scene. O(triangles of meshes), about 65 bytes per triangle of a mesh.
  explicit Occlusion(const Surfaces& surfaces, ObjectUnit unit = ObjectUnit::instances,
                     const Execution& execution = {});
  ~Occlusion();
  Occlusion(Occlusion&&) noexcept;
  Occlusion& operator=(Occlusion&&) noexcept;
  Occlusion(const Occlusion&) = delete;
  Occlusion& operator=(const Occlusion&) = delete;

  [[nodiscard]] std::size_t object_count() const;
  /// Objects are in scene order, with the parts of an instance in sequence. Precondition: number < object_count().
  [[nodiscard]] CulledObject object(std::size_t number) const;

  /// Triangles of an object with finite vertices, by number in the mesh. Precondition: number < object_count().
  [[nodiscard]] std::span<const std::uint32_t> triangles(std::size_t number) const;

  /// \returns the visibility of every object in this view, valid until the next call. Faces left out by View::culling
  /// hide nothing. The answer is the same for all instruction sets. Objects are grouped, and hidden or outside groups
  /// cost little. At worst O(objects + triangles of objects that may be seen).
  /// \throws Error bad_argument as validate(view) does, and for a cell out of range.
  std::span<const ObjectSight> cull(const View& view, const OcclusionOptions& options = {},
                                    const Execution& execution = {}) &;
  /// \returns the visibility of a box of world space in the view of the last cull(), for a thing that is not in the
  /// scene or that has moved. The result is `outside` before the first cull(), and for boxes that are empty or contain
  /// NaN. O(cells that the box covers / 512).
  [[nodiscard]] ObjectSight sight_of(const Box& box) const;
  /// sight_of() for many boxes. Precondition: as many sights as boxes. Only the first call allocates memory.
  void find_sights(std::span<const Box> boxes, std::span<ObjectSight> sights) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost
