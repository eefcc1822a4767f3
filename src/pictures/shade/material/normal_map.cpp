// SPDX-License-Identifier: Apache-2.0
#include "shade/material/normal_map.h"

#include <cmath>

namespace frontmost::shading {
namespace {

glm::vec3 unit_or_zero(const glm::dvec3& v) {
  const double length = std::sqrt(glm::dot(v, v));
  return length > 0 && length < 1e300 ? glm::vec3(v / length) : glm::vec3(0);
}

glm::vec3 normalized_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float length2 = v.x * v.x + v.y * v.y + v.z * v.z;
  return length2 > 1e-20f && length2 < 1e20f ? v * (1.0f / std::sqrt(length2)) : fallback;
}

}  // namespace

NormalMap::TangentFrame NormalMap::frame_of(const TriangleSetup& t) const {
  std::array<glm::dvec2, 3> uv;
  for (std::size_t k = 0; k < 3; ++k) uv[k] = glm::dvec2(slot_->transform.place(t.texcoord[slot_->set][k]));
  const glm::dvec3 edge1 = glm::dvec3(t.corner[1] - t.corner[0]), edge2 = glm::dvec3(t.corner[2] - t.corner[0]);
  const glm::dvec2 uv1 = uv[1] - uv[0], uv2 = uv[2] - uv[0];
  const double area = uv1.x * uv2.y - uv2.x * uv1.y;
  const double sign = area < 0 ? -1 : 1;
  return {unit_or_zero((edge1 * uv2.y - edge2 * uv1.y) * sign), unit_or_zero((edge2 * uv1.x - edge1 * uv2.x) * sign)};
}

void NormalMap::turn(const NumberedTriangle& triangle, const glm::vec4& texel, int i, Lane3& normals) {
  const TriangleSetup& t = triangle.setup;
  if (!t.has_texcoord[slot_->set]) return;
  if (triangle.number != framed_) {
    frame_ = frame_of(t);
    framed_ = triangle.number;
  }
  const glm::vec3 map = glm::vec3(texel) * 2.0f - 1.0f;
  const glm::vec3 n = normals.at(i);
  const glm::vec3 u = frame_.along_u - n * glm::dot(n, frame_.along_u);
  const glm::vec3 v = frame_.along_v - n * glm::dot(n, frame_.along_v);
  // Green points up in the picture, against v. On the back of a surface, bumps are inverted.
  const float side = (t.is_backside ? -1.0f : 1.0f) * scale_;
  const glm::vec3 turned = normalized_or(u, u) * (map.x * side) - normalized_or(v, v) * (map.y * side) + n * map.z;
  normals.set(i, normalized_or(turned, n));
}

}  // namespace frontmost::shading
