// SPDX-License-Identifier: Apache-2.0
// Tells which triangles have a double-sided material, as Culling::material asks.
//
// Most scenes have materials of one kind only. If both kinds occur, each triangle has a bit.
#pragma once

#include <memory>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost {

/// Whether triangles of a material are double-sided. Triangles without a material are not.
[[nodiscard]] bool is_double_sided(const Scene& scene, std::uint32_t material);

struct MaterialSides {
  bool are_all_double = false;      ///< every triangle is double-sided; ignored unless `bits` is empty
  std::vector<std::uint32_t> bits;  ///< by primitive, 32 a word: double-sided or not; empty if all are alike

  [[nodiscard]] bool is_double(PrimitiveId id) const {
    return bits.empty() ? are_all_double : (bits[id / 32] >> (id % 32) & 1) != 0;
  }
  /// The sides of a scene's triangles. Triangles without a material are one-sided, as the default material is. O(meshes
  /// and instances), and O(triangles) if materials differ.
  [[nodiscard]] static std::shared_ptr<const MaterialSides> of(const Scene& scene,
                                                               const std::vector<PrimitiveId>& first_primitives);
};

}  // namespace frontmost
