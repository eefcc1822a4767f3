// SPDX-License-Identifier: Apache-2.0
// The tree of nodes. A file lists the children of nodes and may be inconsistent: two parents, loops, missing children.
// Each of these is an error. The remaining forest is walked without recursion, because it may be a million levels deep.
#include "io/models/gltf/nodes.h"

#include <algorithm>
#include <cmath>

namespace frontmost::gltf {
namespace {

/// Sizes of the arrays that nodes refer to.
struct Counts {
  std::size_t nodes, meshes, skins, cameras, lights;
};

std::size_t size_or_zero(const JsonValue& root, const char* key) {
  const std::optional<JsonValue> array = root.find(key);
  return array ? array->size() : 0;
}

glm::dmat4 read_transform(const JsonValue& json) {
  double m[16], t[3] = {0, 0, 0}, r[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
  // The format forbids nodes with both; exporters that write both mean the matrix.
  if (json.read_numbers("matrix", m)) {
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = m[i];
    constexpr double tolerance = 1e-6;  // exporters that use floats
    for (int column = 0; column < 4; ++column) {
      const double expected = column == 3 ? 1 : 0;
      if (std::abs(matrix[column][3] - expected) > tolerance) json.require("matrix").fail("is not affine");
      matrix[column][3] = expected;
    }
    return matrix;
  }
  json.read_numbers("translation", t);
  json.read_numbers("rotation", r);
  json.read_numbers("scale", s);
  return compose({t[0], t[1], t[2]}, {r[0], r[1], r[2], r[3]}, {s[0], s[1], s[2]});
}

std::uint32_t copy_attribute(const JsonValue& attributes, const char* key, int components, const Data& data,
                             InstancingAccessors& copies) {
  const std::optional<JsonValue> json = attributes.find(key);
  if (!json) return no_index;
  const std::uint32_t id = data.readable_accessor(*json);
  const Accessor& accessor = data.accessor(id);
  if (accessor.components != components) json->fail("the accessor's type does not fit");
  // The test is for an earlier attribute, not for its elements, because later code uses one count for all attributes.
  const bool is_first = copies.translation == no_index && copies.rotation == no_index && copies.scale == no_index;
  if (!is_first && copies.count != accessor.count)
    json->fail("has another number of elements than the attributes before");
  copies.count = accessor.count;
  return id;
}

std::optional<InstancingAccessors> read_copies(const JsonValue& node, const Data& data) {
  const std::optional<JsonValue> extension = node.extension("EXT_mesh_gpu_instancing");
  if (!extension) return std::nullopt;
  const JsonValue attributes = extension->require("attributes");
  InstancingAccessors copies;
  copies.translation = copy_attribute(attributes, "TRANSLATION", 3, data, copies);
  copies.rotation = copy_attribute(attributes, "ROTATION", 4, data, copies);
  copies.scale = copy_attribute(attributes, "SCALE", 3, data, copies);
  return copies;
}

Node read_node(const JsonValue& json, const Counts& counts, const Data& data) {
  Node node;
  node.place = json.place();
  node.name = json.name();
  node.mesh = json.index_or_none("mesh", counts.meshes);
  node.skin = json.index_or_none("skin", counts.skins);
  node.camera = json.index_or_none("camera", counts.cameras);
  if (const auto light = json.extension("KHR_lights_punctual"))
    node.light = light->require("light").to_index(counts.lights);
  node.world = read_transform(json);  // relative to the parent until all parents are known
  node.copies = read_copies(json, data);
  if (const auto visibility = json.extension("KHR_node_visibility"))
    node.is_hidden = !visibility->bool_or("visible", true);
  const std::optional<JsonValue> children = json.find("children");
  for (std::size_t i = 0; children && i < children->size(); ++i)
    node.children.push_back((*children)[i].to_index(counts.nodes));
  if (const std::optional<JsonValue> weights = json.find("weights")) {
    node.weights.resize(weights->size());
    weights->to_numbers(node.weights);
  }
  return node;
}

// Each node has at most one parent, so the graph is a forest with unique world transforms. A loop cannot be reached
// from a root, so finding loops needs no search of its own.
void find_parents(std::vector<Node>& nodes, const ModelSource& source) {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const std::uint32_t child : nodes[i].children) {
      if (nodes[child].parent != no_index)
        source.fail(nodes[child].place,
                    "is a child of both " + nodes[nodes[child].parent].place + " and " + nodes[i].place);
      nodes[child].parent = std::uint32_t(i);
    }
}

/// The nodes from `starts` downwards, in order, each before its children. The stack is explicit, since trees may be a
/// million levels deep.
std::vector<std::uint32_t> walk(const std::vector<Node>& nodes, std::vector<std::uint32_t> starts) {
  std::vector<std::uint32_t> order, stack(starts.rbegin(), starts.rend());
  std::vector<bool> seen(nodes.size());
  while (!stack.empty()) {
    const std::uint32_t id = stack.back();
    stack.pop_back();
    // A scene may name a node and its child, or a node twice; each node is shown once.
    if (seen[id]) continue;
    seen[id] = true;
    order.push_back(id);
    stack.insert(stack.end(), nodes[id].children.rbegin(), nodes[id].children.rend());
  }
  return order;
}

bool is_finite_matrix(const glm::dmat4& m) {
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(m[i / 4][i % 4])) return false;
  return true;
}

/// Converts transforms to world space and hides nodes below hidden ones. \returns the nodes without parents.
std::vector<std::uint32_t> place_in_world(std::vector<Node>& nodes, const ModelSource& source) {
  std::vector<std::uint32_t> roots;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].parent == no_index) roots.push_back(std::uint32_t(i));
  const std::vector<std::uint32_t> order = walk(nodes, roots);
  // Since nodes have at most one parent, only nodes of a loop cannot be reached from a root.
  if (order.size() < nodes.size()) {
    std::vector<bool> reached(nodes.size());
    for (const std::uint32_t id : order) reached[id] = true;
    const auto lost = std::size_t(std::find(reached.begin(), reached.end(), false) - reached.begin());
    source.fail(nodes[lost].place, "is part of a loop of nodes");
  }
  for (const std::uint32_t id : order) {
    Node& node = nodes[id];
    if (node.parent != no_index) {
      node.world = nodes[node.parent].world * node.world;
      node.is_hidden |= nodes[node.parent].is_hidden;
    }
    if (!is_finite_matrix(node.world)) source.fail(node.place, "its transform is not finite");
  }
  return roots;
}

/// Start nodes of the shown scene. A start node with a parent keeps the parent's transform.
std::vector<std::uint32_t> scene_starts(const JsonValue& root, std::size_t node_count,
                                        std::vector<std::uint32_t> roots) {
  const std::optional<JsonValue> scenes = root.find("scenes");
  const std::uint32_t chosen = root.index_or_none("scene", scenes ? scenes->size() : 0);
  if (!scenes || scenes->size() == 0) return roots;
  std::vector<std::uint32_t> starts;
  const std::optional<JsonValue> nodes = (*scenes)[chosen == no_index ? 0 : chosen].find("nodes");
  for (std::size_t i = 0; nodes && i < nodes->size(); ++i) starts.push_back((*nodes)[i].to_index(node_count));
  return starts;
}

}  // namespace

glm::dmat4 compose(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale) {
  const double length = glm::length(rotation);
  // Quaternions in files are rounded, so they are normalised; a zero quaternion means no rotation.
  const glm::dvec4 q = length > 0 ? rotation / length : glm::dvec4(0, 0, 0, 1);
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  glm::dmat4 m(1.0);
  m[0] = glm::dvec4(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0) * scale.x;
  m[1] = glm::dvec4(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0) * scale.y;
  m[2] = glm::dvec4(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0) * scale.z;
  m[3] = glm::dvec4(translation, 1);
  return m;
}

NodeTree read_nodes(const JsonValue& root, const Data& data, std::vector<std::string>& warnings) {
  NodeTree tree;
  const std::optional<JsonValue> array = root.find("nodes");
  const std::optional<JsonValue> lights = find_lights(root);
  const Counts counts{array ? array->size() : 0, size_or_zero(root, "meshes"), size_or_zero(root, "skins"),
                      size_or_zero(root, "cameras"), lights ? lights->size() : 0};
  for (std::size_t i = 0; i < counts.nodes; ++i) tree.nodes.push_back(read_node((*array)[i], counts, data));
  find_parents(tree.nodes, root.source());
  std::vector<std::uint32_t> roots = place_in_world(tree.nodes, root.source());
  tree.shown = walk(tree.nodes, scene_starts(root, counts.nodes, std::move(roots)));
  const auto hidden =
      std::count_if(tree.shown.begin(), tree.shown.end(), [&](std::uint32_t id) { return tree.nodes[id].is_hidden; });
  if (hidden > 0)
    warnings.push_back("KHR_node_visibility: the file hides " + std::to_string(hidden) + " of " +
                       std::to_string(tree.shown.size()) + " nodes");
  return tree;
}

}  // namespace frontmost::gltf
