// SPDX-License-Identifier: Apache-2.0
// What triangles take of a grid over the picture.
#pragma once

#include "lines/hiding/cell_depth.h"
#include "lines/mesh/seen_mesh.h"

namespace frontmost::lines_detail {

/// Cells: more than the rounding of any place in the picture.
inline constexpr double kCellPad = 1e-6;

/// A triangle's box in cells' units; `nearest` is infinite where it is not seen.
struct Footprint {
  glm::vec2 low, high;
  float nearest;
  std::uint32_t triangle;
};

/// Below the value, by up to 2^-22 of it: whatever it is rounded to.
inline float rounded_down(double value) { return float(value - std::abs(value) * 2e-7); }
inline float rounded_up(double value) { return -rounded_down(-value); }

/// Triangles on a grid.
struct OnGrid {
  const SeenMesh& seen;
  const Sight sight;
  Buffer<glm::dvec3> places;  ///< of vertices: x and y in cells, z the planar distance

  [[nodiscard]] CellDepth depth_of(std::uint32_t triangle) const {
    const glm::uvec3& t = seen.mesh.triangles[triangle];
    return {places[t.x], places[t.y], places[t.z], sight.is_parallel()};
  }
  /// Whether some of the triangle may lie before the near plane.
  [[nodiscard]] bool is_near(const Footprint& footprint) const {
    return double(footprint.nearest) <= sight.near() + 1e-6 * std::abs(sight.near());
  }
};

}  // namespace frontmost::lines_detail
