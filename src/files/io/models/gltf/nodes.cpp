// SPDX-License-Identifier: Apache-2.0
// The tree of nodes, and the meshes that they place. A file lists the children of nodes and may be inconsistent: two
// parents, loops, missing children. Each of these is an error. The remaining forest is walked without recursion,
// because it may be a million levels deep.
//
//   node with a mesh    --not posed--------> an instance of the mesh, with the node's transform
//                      --morph, skin------> a mesh of its own, read again in that pose; equal poses are read once
//                      --instancing-------> an instance for each copy
//
// Skinned vertices are in world space already: the format ignores the transform of their node.
#include "io/models/gltf/nodes.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "scene/origin.h"

namespace frontmost::gltf {
namespace {

/// The lengths of the lists that nodes refer to.
struct Counts {
  std::size_t nodes, meshes, skins, cameras, lights;
};

glm::dmat4 read_transform(const JsonValue& json) {
  // The format forbids nodes with a matrix and other transforms. Exporters that write both mean the matrix.
  glm::dmat4 matrix;
  if (json.read_numbers("matrix", {&matrix[0][0], 16})) {
    constexpr double tolerance = 1e-6;  // exporters that use floats
    for (int column = 0; column < 4; ++column) {
      const double expected = column == 3 ? 1 : 0;
      if (std::abs(matrix[column][3] - expected) > tolerance) json.require("matrix").fail("is not affine");
      matrix[column][3] = expected;
    }
    return matrix;
  }
  glm::dvec3 translation(0), scale(1);
  glm::dvec4 rotation(0, 0, 0, 1);
  json.read_vector("translation", translation);
  json.read_vector("rotation", rotation);
  json.read_vector("scale", scale);
  return compose(translation, rotation, scale);
}

std::uint32_t copy_attribute(const JsonValue& attributes, const char* key, int components, const Data& data,
                             InstancingAccessors& copies) {
  const std::optional<JsonValue> json = attributes.find(key);
  if (!json) return no_index;
  const std::uint32_t id = data.readable_accessor(*json);
  const Accessor& accessor = data.accessor(id);
  if (accessor.components != components) json->fail("the accessor's type does not fit");
  // The test is whether an attribute came before, not whether it had elements, because later code uses one count for
  // all.
  const bool is_first = copies.translation == no_index && copies.rotation == no_index && copies.scale == no_index;
  if (!is_first && copies.count != accessor.count) json->fail("has another number of elements than earlier attributes");
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
  json.each("children", [&](const JsonValue& child) { node.children.push_back(child.to_index(counts.nodes)); });
  node.weights.resize(json.count("weights"));
  json.read_numbers("weights", node.weights);
  return node;
}

/// Gives each node its parent. No node may have two, so that the graph is a forest with unique world transforms.
void find_parents(std::vector<Node>& nodes, const ModelSource& source) {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const std::uint32_t child : nodes[i].children) {
      if (nodes[child].parent != no_index)
        source.fail(nodes[child].place,
                    "is a child of both " + nodes[nodes[child].parent].place + " and " + nodes[i].place);
      nodes[child].parent = std::uint32_t(i);
    }
}

/// Returns the nodes from `starts` downwards, in order, each before its children. The stack is explicit, because trees
/// may be a million levels deep.
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

/// Returns the nodes at which the shown scene starts. A start node with a parent keeps the parent's transform.
std::vector<std::uint32_t> scene_starts(const JsonValue& root, std::size_t node_count,
                                        std::vector<std::uint32_t> roots) {
  const std::size_t scene_count = root.count("scenes");
  const std::uint32_t chosen = root.index_or_none("scene", scene_count);
  if (scene_count == 0) return roots;
  std::vector<std::uint32_t> starts;
  const JsonValue scene = root.require("scenes")[chosen == no_index ? 0 : chosen];
  scene.each("nodes", [&](const JsonValue& node) { starts.push_back(node.to_index(node_count)); });
  return starts;
}

/// For each joint of a skin in rest pose, the matrix world_from_joint * inverse bind matrix.
using Joints = std::vector<glm::dmat4>;

/// The joints of a skin. Skinned vertices are stored in world space, or relative to an origin near them if they lie far
/// from zero.
struct Skin {
  Joints joints;
  glm::dvec3 origin{0};

  explicit Skin(Joints in_world) : joints(std::move(in_world)) {
    OriginSearch search;
    for (const glm::dmat4& joint : joints) search.include(glm::dvec3(joint[3]));
    origin = search.origin();
    for (glm::dmat4& joint : joints) joint[3] -= glm::dvec4(origin, 0);
  }
  [[nodiscard]] glm::dmat4 world_from_mesh() const {
    glm::dmat4 moved(1.0);
    moved[3] = glm::dvec4(origin, 1);
    return moved;
  }
};

Joints read_joints(const JsonValue& json, const Data& data, const std::vector<Node>& nodes) {
  Joints skin;
  const JsonValue joints = json.require("joints");
  for (std::size_t i = 0; i < joints.size(); ++i) skin.push_back(nodes[joints[i].to_index(nodes.size())].world);
  if (skin.empty()) joints.fail("a skin without joints");
  const std::optional<JsonValue> bind = json.find("inverseBindMatrices");
  if (!bind) return skin;
  const Accessor& accessor = data.accessor(data.readable_accessor(*bind));
  if (accessor.components != 16 || accessor.component != Component::f32)
    bind->fail("the accessor is not of float MAT4");
  if (accessor.count < skin.size())
    bind->fail(std::to_string(accessor.count) + " matrices for " + std::to_string(skin.size()) + " joints");
  std::vector<glm::mat4> matrices(skin.size());
  read_floats(accessor, {0, matrices.size()}, 16, &matrices[0][0][0]);
  for (std::size_t i = 0; i < skin.size(); ++i) skin[i] *= glm::dmat4(matrices[i]);
  return skin;
}

std::vector<Skin> read_skins(const JsonValue& root, const Data& data, const std::vector<Node>& nodes) {
  std::vector<Skin> skins;
  root.each("skins", [&](const JsonValue& json) { skins.emplace_back(read_joints(json, data, nodes)); });
  return skins;
}

/// Reads each mesh once for each of its poses.
class PosedMeshes {
 public:
  PosedMeshes(const JsonValue& root, const Data& data, const std::vector<MeshPlan>& plans, const NodeTree& tree,
              Scene& scene)
      : source_(root.source()),
        data_(data),
        plans_(plans),
        tree_(tree),
        scene_(scene),
        budget_(data.byte_count()),
        skins_(read_skins(root, data, tree.nodes)),
        is_read_(plans.size()) {}

  void place() {
    scene_.meshes.resize(plans_.size());
    for (const std::uint32_t id : tree_.shown) {
      const Node& node = tree_.nodes[id];
      if (node.mesh == no_index) continue;
      if (node.is_hidden)
        scene_.source.hidden.push_back(name_of_node(node));
      else
        place_node(node);
    }
    for (std::uint32_t i = 0; i < plans_.size(); ++i)
      // Meshes that no node shows are read, too: they keep the file's numbers, and a user may place them.
      if (!is_read_[i]) (void)read(i, {plans_[i].weights});
  }

 private:
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::vector<double>>;

  [[nodiscard]] const std::string& name_of_node(const Node& node) const {
    const std::string& name = plans_[node.mesh].name;
    return !node.name.empty() ? node.name : !name.empty() ? name : node.place;
  }

  void place_node(const Node& node) {
    const MeshPlan& plan = plans_[node.mesh];
    if (plan.primitives.empty()) return;
    // A skin places its mesh in the world, so the node's transform is ignored.
    const bool skinned = node.skin != no_index && plan.has_joints;
    Instance instance;
    instance.name = name_of_node(node);
    instance.mesh = posed_mesh(node, skinned);
    const std::uint64_t copies = node.copies ? node.copies->count : 1;
    budget_.charge_placed(copies * scene_.meshes[instance.mesh].triangles.size(), node.place, source_);
    instance.world_from_mesh = skinned ? skins_[node.skin].world_from_mesh() : node.world;
    if (node.copies)
      place_copies(node, instance);
    else
      scene_.instances.push_back(std::move(instance));
  }

  std::uint32_t posed_mesh(const Node& node, bool skinned) {
    const MeshPlan& plan = plans_[node.mesh];
    if (!node.weights.empty() && node.weights.size() != plan.target_count)
      source_.fail(node.place + ".weights", std::to_string(node.weights.size()) + " weights for " +
                                                std::to_string(plan.target_count) + " morph targets");
    VertexPose pose{node.weights.empty() ? plan.weights : node.weights};
    // Weights are charged, because each node stores and compares them, even if they come from its mesh.
    budget_.charge(pose.weights.size(), sizeof(double), node.place, source_);
    if (skinned) pose.joints = skins_[node.skin].joints, pose.origin = skins_[node.skin].origin;
    // The skin's number stands for its joints in the key, because comparing matrices would cost more than posing.
    const Key key{node.mesh, skinned ? node.skin : no_index, pose.weights};
    const auto known = posed_.find(key);
    if (known != posed_.end()) return known->second;
    const std::uint32_t number = read(node.mesh, pose);
    posed_.emplace(key, number);
    return number;
  }

  std::uint32_t read(std::uint32_t mesh, const VertexPose& pose) {
    check_cancelled(source_.execution());
    // Warnings about a mesh are kept once, not for each of its poses.
    std::vector<std::string> repeated;
    Mesh posed = read_mesh(plans_[mesh], pose, data_, budget_, source_, is_read_[mesh] ? repeated : scene_.warnings);
    posed.origin = pose.origin;
    std::uint32_t number = mesh;
    if (is_read_[mesh]) {
      number = std::uint32_t(scene_.meshes.size());
      scene_.meshes.emplace_back();
    }
    is_read_[mesh] = true;
    scene_.meshes[number] = std::move(posed);
    return number;
  }

  /// Adds one instance for each element of the attributes of EXT_mesh_gpu_instancing.
  void place_copies(const Node& node, const Instance& first) {
    const InstancingAccessors& copies = *node.copies;
    budget_.charge(copies.count, sizeof(Instance) + first.name.size() + 64, node.place, source_);
    const std::vector<glm::vec4> translations = elements(copies.translation, copies.count, glm::vec4(0));
    const std::vector<glm::vec4> rotations = elements(copies.rotation, copies.count, glm::vec4(0, 0, 0, 1));
    const std::vector<glm::vec4> scales = elements(copies.scale, copies.count, glm::vec4(1));
    for (std::size_t i = 0; i < copies.count; ++i) {
      Instance& copy = scene_.instances.emplace_back(first);
      copy.name.append("[").append(std::to_string(i)).append("]");
      copy.world_from_mesh =
          first.world_from_mesh * compose(glm::dvec3(translations[i]), glm::dvec4(rotations[i]), glm::dvec3(scales[i]));
    }
  }

  [[nodiscard]] std::vector<glm::vec4> elements(std::uint32_t accessor, std::size_t count, glm::vec4 absent) const {
    std::vector<glm::vec4> values(count, absent);
    if (accessor != no_index && count != 0) read_floats(data_.accessor(accessor), {0, count}, 4, &values[0][0]);
    return values;
  }

  const ModelSource& source_;
  const Data& data_;
  const std::vector<MeshPlan>& plans_;
  const NodeTree& tree_;
  Scene& scene_;
  Budget budget_;
  std::vector<Skin> skins_;
  std::vector<bool> is_read_;
  std::map<Key, std::uint32_t> posed_;
};

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
  const std::optional<JsonValue> lights = find_lights(root);
  const Counts counts{root.count("nodes"), root.count("meshes"), root.count("skins"), root.count("cameras"),
                      lights ? lights->size() : 0};
  root.each("nodes", [&](const JsonValue& json) { tree.nodes.push_back(read_node(json, counts, data)); });
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

void place_meshes(const JsonValue& root, const Data& data, const std::vector<MeshPlan>& plans, const NodeTree& tree,
                  Scene& scene) {
  PosedMeshes(root, data, plans, tree, scene).place();
}

}  // namespace frontmost::gltf
