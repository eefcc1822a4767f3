// SPDX-License-Identifier: Apache-2.0
#include "cli/view/places.h"

#include <fmt/format.h>

namespace frontmost::cli {

std::string place_text(const glm::dvec3& in_scene, const glm::dvec3& origin) {
  const glm::dvec3 p = in_file(in_scene, origin);
  return origin == glm::dvec3(0) ? fmt::format("{:.6g},{:.6g},{:.6g}", p.x, p.y, p.z)
                                 : fmt::format("{},{},{}", p.x, p.y, p.z);
}

}  // namespace frontmost::cli
