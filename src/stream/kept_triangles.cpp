// SPDX-License-Identifier: Apache-2.0
#include "stream/kept_triangles.h"

namespace frontmost::streaming {
namespace {

template <class T>
void append_corners(const Mesh& from, const Attribute<T>& attribute, std::uint32_t triangle, Attribute<T>& to) {
  if (attribute.empty()) return;
  const glm::uvec3& corners = from.corners(attribute, triangle);
  for (int k = 0; k < 3; ++k) to.values.push_back(attribute.values[corners[k]]);
}

}  // namespace

void append_triangle(const Mesh& from, std::uint32_t triangle, Mesh& to) {
  const auto first = std::uint32_t(to.positions.size());
  for (int k = 0; k < 3; ++k) to.positions.push_back(from.positions[from.triangles[triangle][k]]);
  append_corners(from, from.normals, triangle, to.normals);
  append_corners(from, from.texcoords, triangle, to.texcoords);
  append_corners(from, from.colors, triangle, to.colors);
  // One for each, also where one for all would do: pieces of one mesh may differ in that.
  if (!from.material_ids.empty()) to.material_ids.push_back(from.material_of(triangle));
  to.triangles.emplace_back(first, first + 1, first + 2);
}

}  // namespace frontmost::streaming
