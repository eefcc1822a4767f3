// SPDX-License-Identifier: Apache-2.0
// A visible triangle prepared for interpolation.
#pragma once

#include <array>

#include "frontmost/scene.h"
#include "view/ray_volumes.h"

namespace frontmost::shading {

/// A value that is affine in the screen position, relative to a reference point.
struct Affine {
  float at_reference = 0, step_x = 0, step_y = 0;
};

struct TriangleSetup {
  std::array<Affine, 3> weight;     ///< their sum at the reference is 1
  glm::vec2 reference{0};           ///< screen
  std::array<glm::vec3, 3> corner;  ///< world axes, from the eye
  std::array<glm::vec3, 3> corner_world;
  std::array<glm::vec3, 3> normal;  ///< world, unit, on the viewer's side
  glm::vec3 plane_normal{0};        ///< unit, towards the viewer
  bool is_smooth = false;           ///< the corner normals differ from the plane's
  bool is_backside = false;         ///< the visible side is the back by the winding
  PrimitiveId id = no_primitive;
  std::uint32_t instance = no_index, mesh = no_index, triangle = no_index;
  std::uint32_t material = no_index;  ///< number in the scene
  std::array<glm::vec4, 3> color;
  bool has_color = false;
  std::array<bool, max_texcoord_sets> has_texcoord{};                ///< by set
  std::array<std::array<glm::vec2, 3>, max_texcoord_sets> texcoord;  ///< zero in the first set if it is missing

  /// The texture coordinates of corner k; zero if the mesh has no such set.
  [[nodiscard]] glm::vec2 texcoord_at(std::uint32_t set, std::size_t k) const {
    return has_texcoord[set] ? texcoord[set][k] : glm::vec2(0);
  }
};

/// Fills weights, reference, corners, plane normal, and is_backside (for a triangle that was not mirrored).
/// Triangles that are seen edge-on, and non-finite results, get equal weights everywhere.
void set_up_plane(TriangleSetup& setup, const ScreenRays& rays, const std::array<glm::vec3, 3>& corners_world,
                  const glm::vec2& reference);

/// Weights at a screen position: none is negative and they sum to 1, so interpolation stays within the triangle.
/// `divisor` is their sum before normalization, which gradients need.
struct Barycentric {
  glm::vec3 weight;
  float divisor;
};
[[nodiscard]] inline Barycentric barycentric(const TriangleSetup& t, float x, float y) {
  const float dx = x - t.reference.x, dy = y - t.reference.y;
  glm::vec3 w;
  for (int k = 0; k < 3; ++k) {
    const Affine& a = t.weight[std::size_t(k)];
    const float value = a.at_reference + dx * a.step_x + dy * a.step_y;
    w[k] = value > 0.0f ? value : 0.0f;
  }
  const float sum = w.x + w.y + w.z;
  const bool valid = sum > 1e-30f;
  const float scale = valid ? 1.0f / sum : 0.0f;
  const float rest = valid ? 0.0f : 1.0f / 3;
  return {{w.x * scale + rest, w.y * scale + rest, w.z * scale + rest}, valid ? sum : 1.0f};
}

}  // namespace frontmost::shading
