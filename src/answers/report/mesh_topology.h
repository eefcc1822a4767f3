// SPDX-License-Identifier: Apache-2.0
// Topology of a mesh: which triangles are connected, by edges or by vertices, and whether the surface is closed.
//
//      +---+---+
//      | / | / |      one shell: connected by an edge
//      +---+---+---+
//              | / |      another shell of the same piece: connected by a vertex alone
//              +---+
//
// Vertices are the same if their positions are, whatever their numbers, so files with and without shared vertices are
// examined alike.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "frontmost/report.h"

namespace frontmost {

struct Topology {
  Oddities odd;
  std::uint64_t pieces = 0, shells = 0;
  bool closed = false;
  std::optional<std::uint64_t> genus;
  std::vector<glm::vec3> points;  ///< different positions of finite triangles
};

/// Examines a mesh. Precondition: indices are in range. \throws Error limit_exceeded.
[[nodiscard]] Topology examine(const Mesh& mesh, const Execution& execution);

/// Whether the triangle's area is exactly zero, for its floats as they are. Precondition: the floats are finite.
[[nodiscard]] bool are_collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace frontmost
