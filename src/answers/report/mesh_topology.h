// SPDX-License-Identifier: Apache-2.0
// How the triangles of one mesh hang together: over which edges, in how many pieces, and whether they close.
//
//      +---+---+
//      | / | / |      one shell: joined over an edge
//      +---+---+---+
//              | / |      another one of the same piece: joined in a corner alone
//              +---+
//
// Corners are the same when their positions are, whatever their numbers, so that a file without shared vertices is
// examined as one with them.
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
  std::vector<glm::vec3> points;  ///< the different positions of finite triangles
};

/// Precondition: indices in range. \throws Error limit_exceeded.
[[nodiscard]] Topology examine(const Mesh& mesh, const Execution& execution);

/// True when the triangle's area is exactly zero, for the floats as they are. Precondition: finite.
[[nodiscard]] bool are_collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace frontmost
