// SPDX-License-Identifier: Apache-2.0
// How the triangles of one mesh hang together.
#pragma once

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

}  // namespace frontmost
