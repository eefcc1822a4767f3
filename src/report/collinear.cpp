// SPDX-License-Identifier: Apache-2.0
// Three points are collinear when their shadows on all three coordinate planes are.
#include "report/collinear.h"

#include "base/orientation.h"

namespace frontmost {

bool are_collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return orientation({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 && orientation({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         orientation({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

}  // namespace frontmost
