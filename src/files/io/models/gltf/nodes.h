// SPDX-License-Identifier: Apache-2.0
// The node tree of a glTF file, and what its nodes place in the world: meshes, posed or not, cameras and lights.
//
//   scene --> node "car"          transform to its parent
//               |-> node "wheel"  mesh 3                       world = car * wheel
//               |-> node "wheel"  mesh 3, somewhere else
//               `-> node "driver" mesh 5, skin 0, and a camera below it
//
// A tree is flattened: instances have their transforms to the world, and the tree itself is forgotten.
#pragma once

#include <glm/glm.hpp>

#include "io/models/gltf/data.h"
#include "io/models/gltf/meshes.h"

namespace frontmost::gltf {

/// Accessors of EXT_mesh_gpu_instancing.
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
  bool is_hidden = false;  ///< by KHR_node_visibility, its own or that of a node above it
  glm::dmat4 world{1.0};   ///< world_from_node
};

struct NodeTree {
  std::vector<Node> nodes;
  /// Nodes of the scene that is shown, each before its children, in the file's order.
  std::vector<std::uint32_t> shown;
};

/// Reads all nodes and finds their places in the world. Shown is the scene that the file names, or its first one, or,
/// in a file without scenes, everything. A warning counts the nodes that the file hides. \throws Error for nodes with
/// two parents and for loops.
[[nodiscard]] NodeTree read_nodes(const JsonValue& root, const Data& data, std::vector<std::string>& warnings);

/// A rigid body's transform from translation, rotation (x, y, z, w; any length) and scale.
[[nodiscard]] glm::dmat4 compose(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale);

/// Fills scene.meshes and scene.instances. Meshes keep the file's numbers; a mesh that is posed in several ways is
/// there several times, the others at the end. Meshes of hidden nodes, and of no shown node, are read, but not placed.
void place_meshes(const JsonValue& root, const Data& data, const std::vector<MeshPlan>& plans, const NodeTree& tree,
                  Scene& scene);

/// Fills scene.cameras, one for each shown node that has one. Hidden nodes keep their cameras, as the extension asks.
void place_cameras(const JsonValue& root, const NodeTree& tree, Scene& scene);

/// The lights that nodes name by number (KHR_lights_punctual), if the file has any.
[[nodiscard]] std::optional<JsonValue> find_lights(const JsonValue& root);
/// Fills scene.lights, one for each shown node that has one and is not hidden.
void place_lights(const JsonValue& root, const NodeTree& tree, Scene& scene);

}  // namespace frontmost::gltf
