// SPDX-License-Identifier: Apache-2.0
// The teapot as triangles: every patch is a grid, and points that two patches share are stored once.
//
// Patches of one part (body with lid and bottom, handle, spout) are welded where their points agree to the bit, which
// evaluate() guarantees along shared edges. Parts are not welded to each other: the handle touches the body in one
// point, at an angle.
#include <algorithm>
#include <map>
#include <tuple>

#include "scene/bezier_patch.h"
#include "scene/shapes.h"

namespace frontmost {
namespace {

constexpr std::size_t kFirstHandlePatch = 24, kFirstSpoutPatch = 28;  // first patches; turned patches come before

struct ByCoordinates {
  bool operator()(const glm::vec3& a, const glm::vec3& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

// Stores each position of a part once, with the normal of the first patch that reaches it. Patches of one part are
// tangent to each other where they meet, so their normals agree but for rounding. Parts are not tangent: the handle
// touches the body in one point, (-2, 0.9, 0), at an angle.
class Welder {
 public:
  explicit Welder(Mesh& mesh) : mesh_(mesh) {}
  void start_part() { numbers_.clear(); }
  std::uint32_t add(const PatchPoint& point) {
    // + 0.0f: reflected coordinates may be -0, which is the same place.
    const glm::vec3 position = glm::vec3(point.position) + 0.0f;
    const auto [place, is_new] = numbers_.try_emplace(position, std::uint32_t(mesh_.positions.size()));
    if (is_new) {
      mesh_.positions.push_back(position);
      mesh_.normals.values.emplace_back(point.normal);
    }
    return place->second;
  }

 private:
  Mesh& mesh_;
  std::map<glm::vec3, std::uint32_t, ByCoordinates> numbers_;
};

void add_triangle(const glm::uvec3& corners, const glm::uvec3& texcoords, std::uint32_t patch, Mesh& mesh) {
  // At a pole one side of the quad is a point.
  if (corners.x == corners.y || corners.y == corners.z || corners.z == corners.x) return;
  mesh.triangles.push_back(corners);
  mesh.texcoords.triangles.push_back(texcoords);
  mesh.face_ids.push_back(patch);
}

}  // namespace

Mesh teapot(int steps) {
  Mesh mesh;
  Welder welder(mesh);
  const std::vector<BezierPatch> patches = teapot_patches();
  const int side = steps + 1;
  std::vector<std::uint32_t> corners(std::size_t(side) * std::size_t(side));
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    if (p == kFirstHandlePatch || p == kFirstSpoutPatch) welder.start_part();
    const auto first_texcoord = std::uint32_t(mesh.texcoords.values.size());
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j) {
        const PatchParameter u = fraction(i, steps), v = fraction(j, steps);
        corners[std::size_t(i * side + j)] = welder.add(evaluate(patches[p], u, v));
        mesh.texcoords.values.emplace_back(patches[p].texture_low +
                                           patches[p].texture_size * glm::dvec2(v.value, u.value));
      }
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const auto at = std::uint32_t(i * side + j), below = at + std::uint32_t(side);
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
          add_triangle({corners[a], corners[b], corners[c]}, first_texcoord + glm::uvec3(a, b, c), p, mesh);
        };
        add(at, at + 1, below + 1);
        add(at, below + 1, below);
      }
  }
  mesh.patches = patches;
  return mesh;
}

}  // namespace frontmost
