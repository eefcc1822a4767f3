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
      : surfaces(from), triangles(from), materials(from.scene()), shadows(from), looked_at(from.primitive_count()) {}

  /// Makes the textures ready that are looked at on these primitives.
  void make_materials_ready(const BitSet& primitives, const Execution& execution) {
    if (materials.is_ready() || looked_at.holds(primitives)) return;
    materials.make_ready(seen_materials(surfaces, primitives, looked_at), execution);
    looked_at.add_all(primitives);  // not where that failed
  }
  /// The same of what a Visible shows, which is not looked at where nothing is left to be made ready.
  void make_materials_ready(const Visible& visible, const Execution& execution) {
    if (materials.is_ready()) return;
    seen = seen_primitives(surfaces, visible, execution, std::move(seen));
    make_materials_ready(seen, execution);
  }

  const Surfaces& surfaces;
  TriangleStore triangles;
  MaterialTable materials;
  KeyShadows shadows;
  BitSet looked_at;  ///< primitives whose materials are ready

  // Memory that one picture leaves to the next.
  Pool<TileWork> works;
  BitSet seen, large;
};

}  // namespace frontmost::shading
