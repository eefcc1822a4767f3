// SPDX-License-Identifier: Apache-2.0
// A model as OpenCASCADE gives it, and its binary glTF file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontmost::import {

using Color = std::array<float, 4>;  ///< linear, with alpha

/// A circle on which some of a part's sharp edges lie.
struct EdgeCircle {
  std::array<double, 3> centre, axis;
  double radius;
  std::uint32_t first, count;  ///< range of Part::sharp, in edges
};

inline constexpr std::uint32_t kNoMaterial = 0xFFFFFFFF;

/// Triangles of one colour.
struct Faces {
  std::uint32_t material = kNoMaterial;
  std::vector<std::uint32_t> corners;  ///< three for each triangle
};

/// A mesh. Faces that meet at an edge have vertices at the same places there.
struct Part {
  std::string name;
  std::vector<float> positions, normals;  ///< three numbers for each vertex
  std::vector<Faces> faces;
  std::vector<std::uint32_t> sharp, smooth;  ///< edges: two vertices for each
  std::vector<EdgeCircle> circles;
};

/// A part at one place.
struct Placed {
  std::string name;
  std::uint32_t part = 0;
  std::array<double, 16> matrix{};  ///< by columns
};

struct Model {
  std::vector<Color> materials;
  std::vector<Part> parts;
  std::vector<Placed> placed;
};

/// Edges are primitives of lines, with what docs/formats.md says of the extension FRONTMOST_edges.
[[nodiscard]] std::string glb_of(const Model& model);

}  // namespace frontmost::import
