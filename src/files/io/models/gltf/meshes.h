// SPDX-License-Identifier: Apache-2.0
// Meshes of a glTF file. All triangle primitives of a mesh become one Mesh, in order, with vertices moved by morph
// targets and joints if needed.
#pragma once

#include <array>
#include <tuple>

#include "io/models/gltf/data.h"
#include "io/models/gltf/materials.h"

namespace frontmost::gltf {

/// Accessors of one set of vertices, or of a morph target's displacements.
struct VertexSources {
  std::uint32_t position = no_index, normal = no_index, color = no_index;
  std::array<std::uint32_t, max_texcoord_sets> texcoords;
  VertexSources() { texcoords.fill(no_index); }
};

/// All inputs of a primitive's vertices. Primitives with equal inputs share their vertices.
struct VertexSet {
  VertexSources base;
  std::vector<VertexSources> targets;
  std::vector<std::uint32_t> joints, weights;
};
// Compared without <=>, which arrays and vectors lack in some standard libraries (WebAssembly).
inline bool operator<(const VertexSources& a, const VertexSources& b) {
  return std::tie(a.position, a.normal, a.color, a.texcoords) < std::tie(b.position, b.normal, b.color, b.texcoords);
}
inline bool operator<(const VertexSet& a, const VertexSet& b) {
  return std::tie(a.base, a.targets, a.joints, a.weights) < std::tie(b.base, b.targets, b.joints, b.weights);
}

enum class Mode : std::uint8_t { triangles = 4, strip = 5, fan = 6 };

struct Primitive {
  std::string place;
  VertexSet vertices;
  Mode mode = Mode::triangles;
  std::uint32_t indices = no_index, material = no_index;
  std::size_t vertex_count = 0;
};

/// A checked mesh of the file, without its data.
struct MeshPlan {
  std::string name, place;
  std::vector<Primitive> primitives;  ///< only primitives with triangles
  std::vector<double> weights;        ///< weights of morph targets; may be empty
  std::size_t target_count = 0;
  std::uint32_t texcoord_sets = 1;  ///< sets to read: the first, and those that materials use; bit k: set k
  bool has_joints = false;
};

/// Checks primitives and their accessors. Points, lines and primitives without positions cause warnings. Arrays of
/// compressed primitives are decoded and added to `data`.
[[nodiscard]] std::vector<MeshPlan> plan_meshes(const JsonValue& root, Data& data, const MaterialList& materials,
                                                std::vector<std::string>& warnings);

/// Deformation of vertices: by morph targets, then by joints.
struct VertexPose {
  std::vector<double> weights;              ///< one a target, or none
  std::span<const glm::dmat4> joints = {};  ///< world_from_joint * inverse bind matrix; empty: no skin
  glm::dvec3 origin{0};                     ///< origin of the positions that the joints produce
};

/// Reads the data of planned meshes.
class MeshReader {
 public:
  MeshReader(const Data& data, Budget& budget, const ModelSource& source)
      : data_(data), budget_(budget), source_(source) {}
  [[nodiscard]] Mesh read(const MeshPlan& plan, const VertexPose& pose, std::vector<std::string>& warnings);

 private:
  const Data& data_;
  Budget& budget_;
  const ModelSource& source_;
};

/// A run of a mesh's vertices that come from one vertex set.
struct VertexRun {
  const VertexSet* vertices = nullptr;
  ElementRange range;     ///< range of the accessors' elements; empty: no triangle uses them
  std::size_t first = 0;  ///< first vertex in the mesh
  std::string place;      ///< place of the first primitive that uses them
};

/// Adds weighted displacements to positions, normals, texture coordinates and colours.
void apply_targets(const Data& data, const VertexRun& block, std::span<const double> weights, Mesh& mesh);
/// The values of a set of texture coordinates. Creates the set if absent.
[[nodiscard]] std::vector<glm::vec2>& texcoords_of(Mesh& mesh, std::size_t set);
/// Moves positions and normals by joints. Precondition: the block's vertices have joints.
/// \throws Error file_malformed for a joint that the skin does not have.
void apply_skin(const Data& data, const VertexRun& block, std::span<const glm::dmat4> joints, const ModelSource& source,
                Mesh& mesh);

}  // namespace frontmost::gltf
