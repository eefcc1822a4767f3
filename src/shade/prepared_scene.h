// SPDX-License-Identifier: Apache-2.0
// What all pictures of the same surfaces share, made when the first of them needs it.
#pragma once

#include "base/pool.h"
#include "shade/geometry/geometry.h"
#include "shade/materials.h"
#include "shade/shadow/key_shadows.h"
#include "shade/tile.h"

namespace frontmost::shading {

struct PreparedScene {
  /// Borrows the surfaces and their scene. O(instances + materials).
  explicit PreparedScene(const Surfaces& from)
      : surfaces(from), triangles(from), materials(from.scene()), shadows(from) {}

  /// Makes the textures ready that are looked at on the primitives that `seen()` gives, a BitSet. It is not called
  /// where nothing is left to be made ready.
  template <class Seen>
  void make_materials_ready(const Seen& seen, const Execution& execution) {
    if (!materials.is_ready()) materials.make_ready(seen_materials(surfaces, seen(), execution), execution);
  }

  const Surfaces& surfaces;
  TriangleStore triangles;
  MaterialTable materials;
  KeyShadows shadows;

  // Memory that one picture leaves to the next.
  Pool<TileWork> works;
  BitSet primitives;
};

}  // namespace frontmost::shading
