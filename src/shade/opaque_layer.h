// SPDX-License-Identifier: Apache-2.0
// What stands behind surfaces that can be seen through: leaves cut out of a texture, glass. A Visible knows only the
// front-most primitive, so where that one is see-through, the nearest opaque one behind it is found by a second run
// of the z-buffer, over the scene without see-through triangles. Of several see-through layers the first is shown.
#pragma once

#include <memory>

#include "frontmost/surfaces.h"
#include "frontmost/visible.h"
#include "shade/bit_set.h"

namespace frontmost::shading {

/// Whether any material of the scene is masked or blended.
[[nodiscard]] bool has_see_through(const Scene& scene);

class OpaqueLayer {
 public:
  /// O(triangles + samples). Copies the meshes that hold opaque triangles, but no textures.
  OpaqueLayer(const Surfaces& surfaces, const Visible& front, const Execution& execution);

  /// The opaque part of the scene, with the material numbers of the whole.
  [[nodiscard]] const Surfaces& surfaces() const { return *surfaces_; }
  /// Its front-most primitives, where `front` shows a see-through one; nothing elsewhere.
  [[nodiscard]] const Visible& visible() const { return visible_; }

 private:
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<Surfaces> surfaces_;
  Visible visible_;
};

}  // namespace frontmost::shading
