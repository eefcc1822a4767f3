// SPDX-License-Identifier: Apache-2.0
// Which triangles meet at a vertex.
#pragma once

#include <span>

#include "lines/mesh/welded_mesh.h"

namespace frontmost::lines_detail {

/// A triangle, and which of its corners.
class Corner {
 public:
  static constexpr std::size_t most_triangles = std::size_t(1) << 30;

  Corner(std::uint32_t triangle, std::uint32_t k) : number_(triangle << 2 | k) {}
  [[nodiscard]] std::uint32_t triangle() const { return number_ >> 2; }
  [[nodiscard]] std::uint32_t k() const { return number_ & 3; }
  /// The vertices after and before it. By shifts, and without glm's own operator: that branches.
  [[nodiscard]] std::uint32_t next(const WeldedMesh& mesh) const {
    return (&mesh.triangles[triangle()].x)[9u >> 2 * k() & 3];
  }
  [[nodiscard]] std::uint32_t last(const WeldedMesh& mesh) const {
    return (&mesh.triangles[triangle()].x)[18u >> 2 * k() & 3];
  }

 private:
  std::uint32_t number_;
};

/// The corners of all triangles, those at one vertex together.
class CornerTable {
 public:
  /// O(triangles). \throws Error limit_exceeded for more than Corner::most_triangles.
  CornerTable(const WeldedMesh& mesh, const Execution& execution);

  /// In the order of their triangles.
  [[nodiscard]] std::span<const Corner> at(std::size_t vertex) const {
    return {corners_.data() + first_[vertex], first_[vertex + 1] - first_[vertex]};
  }

 private:
  Buffer<std::uint32_t> first_;  ///< by vertex
  Buffer<Corner> corners_;
};

}  // namespace frontmost::lines_detail
