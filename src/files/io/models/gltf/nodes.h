// SPDX-License-Identifier: Apache-2.0
// The node tree of a glTF file, and the meshes (posed or not), cameras and lights that its nodes place.
//
//   scene --> node "car"          transform to its parent
//               |-> node "wheel"  mesh 3                       world = car * wheel
//               |-> node "wheel"  mesh 3, somewhere else
//               `-> node "driver" mesh 5, skin 0, and a camera below it
//
// The tree is flattened: instances have transforms to world space, and the tree itself is dropped.
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
  bool is_hidden = false;  ///< by KHR_node_visibility of the node or of one above it
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

/// The transform composed of translation, rotation (x, y, z, w; any length) and scale.
[[nodiscard]] glm::dmat4 compose(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale);

/// Fills scene.meshes and scene.instances. Meshes keep the file's numbers; further poses of a mesh are appended at the
/// end. Meshes of hidden nodes and of no shown node are read, but not placed.
void place_meshes(const JsonValue& root, const Data& data, const std::vector<MeshPlan>& plans, const NodeTree& tree,
                  Scene& scene);

/// Fills scene.cameras, one for each shown node with a camera. Hidden nodes keep their cameras, as the extension
/// requires.
void place_cameras(const JsonValue& root, const NodeTree& tree, Scene& scene);

/// The list of lights that nodes refer to by number (KHR_lights_punctual), or nothing.
[[nodiscard]] std::optional<JsonValue> find_lights(const JsonValue& root);
/// Fills scene.lights, one for each shown node that has a light and is not hidden.
void place_lights(const JsonValue& root, const NodeTree& tree, Scene& scene);

}  // namespace frontmost::gltf
