// SPDX-License-Identifier: Apache-2.0
// Which triangles have a material that is seen from both sides: what Culling::material asks for.
//
// Most scenes have materials of one kind alone. Where both kinds occur, a bit tells the triangles apart.
#pragma once

#include <memory>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost {

/// Whether triangles of a material are seen from both sides. Without a material they are not.
[[nodiscard]] bool is_double_sided(const Scene& scene, std::uint32_t material);

struct MaterialSides {
  bool are_all_double = false;      ///< every triangle is double-sided; ignored unless `bits` is empty
  std::vector<std::uint32_t> bits;  ///< by primitive, 32 a word: it is double-sided; empty where all are alike

  [[nodiscard]] bool is_double(PrimitiveId id) const {
    return bits.empty() ? are_all_double : (bits[id / 32] >> (id % 32) & 1) != 0;
  }
  /// Triangles without a material are one-sided, as the default material is. O(meshes and instances), and O(triangles)
  /// where materials differ.
  [[nodiscard]] static std::shared_ptr<const MaterialSides> of(const Scene& scene,
                                                               const std::vector<PrimitiveId>& first_primitives);
};

}  // namespace frontmost
