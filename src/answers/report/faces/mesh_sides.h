// SPDX-License-Identifier: Apache-2.0
// What lies beyond the sides of a mesh's triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost::faces_detail {

/// Side k of triangle t leads from its corner k to the next.
class MeshSides {
 public:
  /// No more triangles than this have room for two bits beside their number.
  static constexpr std::size_t most_triangles = std::size_t(1) << 29;

  /// Corners at one place are one, whatever their numbers. O(triangles * log triangles at a vertex).
  /// \throws Error limit_exceeded.
  explicit MeshSides(const Mesh& mesh);

  /// The triangle beyond a side: the only other one that has it. no_index where there is none, or several.
  [[nodiscard]] std::uint32_t beyond(std::size_t triangle, int side) const {
    const std::uint32_t found = beyond_[3 * triangle + std::size_t(side)];
    return found == no_index ? no_index : found >> 1;
  }
  /// Whether that triangle is wound as this one is: it goes along the side the other way. Precondition: there is one.
  [[nodiscard]] bool is_wound_alike(std::size_t triangle, int side) const {
    return (beyond_[3 * triangle + std::size_t(side)] & 1) != 0;
  }

 private:
  std::vector<std::uint32_t> beyond_;  ///< by triangle and side: number * 2 + whether it is wound alike
};

/// Of every mesh that is placed, by its number; the others have none.
[[nodiscard]] std::vector<MeshSides> sides_of_meshes(const Scene& scene, const Execution& execution);

}  // namespace frontmost::faces_detail
