// SPDX-License-Identifier: Apache-2.0
// The cells of a grid over a scene, and the cells that triangles lie in.
//
//   bit  31        22 21 20        11 10 9         0
//        |  z        | 0 |  y        | 0 |  x       |      the gaps keep a carry of one axis out of the next, so that
//                                                          one subtraction compares three places
#pragma once

#include <array>
#include <cstdint>

#include "frontmost/scene.h"

namespace frontmost {

/// A cell, packed: its places along the axes, 0 to 1023, x in bits 0 to 9, y in 11 to 20, z in 22 to 31.
struct SpaceCell {
  static constexpr int y_shift = 11, z_shift = 22;
  static constexpr std::uint32_t mask = 1023;

  std::uint32_t packed = 0;

  [[nodiscard]] std::uint32_t x() const { return packed & mask; }
  [[nodiscard]] std::uint32_t y() const { return packed >> y_shift & mask; }
  [[nodiscard]] std::uint32_t z() const { return packed >> z_shift; }
  /// True if `other` lies, along every axis, from one cell before this cell to two cells after it.
  [[nodiscard]] bool is_near(SpaceCell other) const {
    // The bit above each place is set before the subtraction, so that no difference borrows from the next place.
    constexpr std::uint64_t ones = 1 | 1ull << y_shift | 1ull << z_shift, lent = ones << 10;
    return (((((other.packed | lent) - packed) + ones) ^ lent) & ~(3 * ones)) == 0;
  }
};

/// Maps the sum of a triangle's vertices, in mesh space, to the triangle's place in the grid, in cells.
struct CellMap {
  std::array<std::array<float, 4>, 3> rows;  ///< by axis: factors of x, y, z, and the constant term
  float last = 0;                            ///< the greatest place along an axis
};

/// Triangles [begin, end) of a mesh.
struct MeshPart {
  const Mesh& mesh;
  std::uint32_t begin = 0, end = 0;
};

/// Finds the cells of triangles, the same ones for any instruction set. The cell is 0 along an axis on which the place
/// is NaN. \returns false if a vertex may not be finite.
bool find_cells(const MeshPart& part, const CellMap& map, Isa isa, SpaceCell* cells);

}  // namespace frontmost
