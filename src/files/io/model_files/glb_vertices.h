// SPDX-License-Identifier: Apache-2.0
// Vertices of glTF: one number for each distinct combination of position, normal, colour and texture coordinates.
//
//   Mesh       positions 0 1 2 3      normals 0 1 with indices of their own: a corner is (position, normal, ...)
//   glTF       vertices (0, 0) (1, 0) (1, 1) ...: each pair that a corner has, once
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost::detail {

/// Indices of a corner's values: position, normal, colour, and texture coordinates by set.
using CornerKey = std::array<std::uint32_t, 3 + max_texcoord_sets>;

inline CornerKey corner_key(const Mesh& mesh, std::uint32_t triangle, int corner) {
  CornerKey key{};
  key[0] = mesh.triangles[triangle][corner];
  if (!mesh.normals.empty()) key[1] = mesh.corners(mesh.normals, triangle)[corner];
  if (!mesh.colors.empty()) key[2] = mesh.corners(mesh.colors, triangle)[corner];
  for (std::uint32_t set = 0; set < max_texcoord_sets; ++set)
    if (const auto* texcoords = mesh.texcoord_set(set)) key[3 + set] = mesh.corners(*texcoords, triangle)[corner];
  return key;
}

struct WeldedCorners {
  std::vector<CornerKey> vertices;
  std::vector<std::uint32_t> indices;  ///< three for each triangle
};

/// Merges equal corners of the given triangles of a mesh. O(n log n).
inline WeldedCorners weld_corners(const Mesh& mesh, std::span<const std::uint32_t> triangles) {
  std::vector<CornerKey> keys;
  keys.reserve(3 * triangles.size());
  for (const std::uint32_t triangle : triangles)
    for (int corner = 0; corner < 3; ++corner) keys.push_back(corner_key(mesh, triangle, corner));
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  WeldedCorners welded;
  welded.indices.resize(keys.size());
  for (const std::uint32_t corner : order) {
    if (welded.vertices.empty() || welded.vertices.back() != keys[corner]) welded.vertices.push_back(keys[corner]);
    welded.indices[corner] = std::uint32_t(welded.vertices.size() - 1);
  }
  return welded;
}

}  // namespace frontmost::detail
