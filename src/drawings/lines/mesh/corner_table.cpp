// SPDX-License-Identifier: Apache-2.0
#include "lines/mesh/corner_table.h"

#include <string>

namespace frontmost::lines_detail {

CornerTable corner_table(const WeldedMesh& mesh, const Execution& execution) {
  if (mesh.triangles.size() > Corner::most_triangles)
    throw Error(ErrorCode::limit_exceeded, "lines",
                "more than " + std::to_string(Corner::most_triangles) + " triangles");
  const auto list = [&](std::size_t t, const auto& add) {
    for (std::uint32_t k = 0; k < 3; ++k) add((&mesh.triangles[t].x)[k], Corner(std::uint32_t(t), k));
  };
  return {mesh.positions.size(), mesh.triangles.size(), list, execution};
}

}  // namespace frontmost::lines_detail
