// SPDX-License-Identifier: Apache-2.0
// Meshes of a glTF file, and the node tree that places them (posed or not), cameras and lights.
//
//   scene --> node "car"          transform to its parent
//               |-> node "wheel"  mesh 3                       world = car * wheel
//               |-> node "wheel"  mesh 3, somewhere else
//               `-> node "driver" mesh 5, skin 0, and a camera below it
//
// All triangle primitives of a mesh become one Mesh, in order. Instances have transforms to the world.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <tuple>

#include "io/models/gltf/data.h"
#include "io/models/gltf/materials.h"

namespace frontmost::gltf {

/// The numbers of the accessors of one set of vertices, or of a morph target's displacements.
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

enum class Mode : std::uint8_t { lines = 1, line_loop = 2, line_strip = 3, triangles = 4, strip = 5, fan = 6 };

struct Primitive {
  std::string place;
  VertexSet vertices;
  Mode mode = Mode::triangles;
  std::uint32_t indices = no_index, material = no_index;
  std::size_t vertex_count = 0;
  // Lines only, from the extension FRONTMOST_edges:
  bool is_smooth = false;
  std::vector<EdgeCircle> circles;
};

/// A checked mesh of the file, without its data.
struct MeshPlan {
  std::string name, place;
  std::vector<Primitive> primitives;  ///< only primitives with triangles
  std::vector<Primitive> edges;       ///< primitives with lines, beside triangles
  std::vector<double> weights;        ///< weights of morph targets; may be empty
  std::size_t target_count = 0;
  std::uint32_t texcoord_sets = 1;  ///< sets to read: the first, and those that materials use; bit k: set k
  bool has_joints = false;
};

/// Checks primitives and their accessors. Lines beside triangles become edges. Points, other lines and primitives
/// without positions cause warnings. Arrays of compressed primitives are decoded and added to `data`.
[[nodiscard]] std::vector<MeshPlan> plan_meshes(const JsonValue& root, Data& data, const MaterialList& materials,
                                                std::vector<std::string>& warnings);

/// A deformation of vertices: by morph targets, then by joints.
struct VertexPose {
  std::vector<double> weights;              ///< one per morph target, or none
  std::span<const glm::dmat4> joints = {};  ///< world_from_joint * inverse bind matrix; empty: no skin
  glm::dvec3 origin{0};                     ///< origin of the positions that the joints produce
};

/// Reads the data of a planned mesh.
[[nodiscard]] Mesh read_mesh(const MeshPlan& plan, const VertexPose& pose, const Data& data, Budget& budget,
                             const ModelSource& source, std::vector<std::string>& warnings);

/// The numbers of the accessors that EXT_mesh_gpu_instancing names.
struct InstancingAccessors {
  std::size_t count = 0;
  std::uint32_t translation = no_index, rotation = no_index, scale = no_index;
};

struct Node {
  std::string name, place;
  std::uint32_t parent = no_index;
  std::uint32_t mesh = no_index, skin = no_index, camera = no_index, light = no_index;
  std::vector<std::uint32_t> children;
  std::vector<double> weights;
  std::optional<InstancingAccessors> copies;
  bool is_hidden = false;  ///< KHR_node_visibility hides the node or a node above it
  glm::dmat4 world{1.0};   ///< world_from_node
};

struct NodeTree {
  std::vector<Node> nodes;
  /// Nodes of the shown scene in the file's order, each before its children.
  std::vector<std::uint32_t> shown;
};

/// Reads all nodes and computes their world transforms. The shown scene is the one that the file selects, or else the
/// first one, or all nodes in a file without scenes. A warning counts hidden nodes. \throws Error for nodes with two
/// parents and for loops.
[[nodiscard]] NodeTree read_nodes(const JsonValue& root, const Data& data, std::vector<std::string>& warnings);

/// Returns the transform composed of translation, rotation (x, y, z, w; any length) and scale.
[[nodiscard]] glm::dmat4 compose(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale);

/// Fills scene.meshes and scene.instances. Meshes keep the file's numbers; further poses of a mesh are appended at the
/// end. Meshes are read, but not placed, if only hidden nodes or nodes that are not shown refer to them.
void place_meshes(const JsonValue& root, const Data& data, const std::vector<MeshPlan>& plans, const NodeTree& tree,
                  Scene& scene);

/// Fills scene.cameras, one for each shown node with a camera. Hidden nodes keep theirs, as the extension requires.
void place_cameras(const JsonValue& root, const NodeTree& tree, Scene& scene);

/// Returns the list of lights that nodes refer to by number (KHR_lights_punctual), or nothing.
[[nodiscard]] std::optional<JsonValue> find_lights(const JsonValue& root);
/// Fills scene.lights, one for each shown node that has a light and is not hidden.
void place_lights(const JsonValue& root, const NodeTree& tree, Scene& scene);

}  // namespace frontmost::gltf
