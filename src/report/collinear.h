// SPDX-License-Identifier: Apache-2.0
// Whether three points lie on one line, exactly.
#pragma once

#include <glm/glm.hpp>

namespace frontmost {

/// True when the triangle's area is exactly zero, for the floats as they are. Precondition: finite.
[[nodiscard]] bool are_collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace frontmost
