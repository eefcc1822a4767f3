// SPDX-License-Identifier: Apache-2.0
// Places meshes in the world: by nodes, by EXT_mesh_gpu_instancing, and posed by weights and joints.
//
//   node with a mesh    --not posed--------> an instance of the mesh, with the node's transform
//                      --morph, skin------> a mesh of its own, read again in that pose; equal poses are read once
//                      --instancing-------> an instance for each copy
//
// Skinned vertices are in world space already: the format ignores the transform of their node.
#include "base/parallel.h"
#include "io/models/gltf/nodes.h"
#include "scene/origin.h"

namespace frontmost::gltf {
namespace {

/// Matrices world_from_joint * inverse bind matrix for the joints of a skin, in rest pose.
using Joints = std::vector<glm::dmat4>;

/// Skinned vertices are stored in world space; if they lie far from zero, they are stored relative to an origin near
/// them.
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
  const std::optional<JsonValue> array = root.find("skins");
  for (std::size_t i = 0; array && i < array->size(); ++i) skins.emplace_back(read_joints((*array)[i], data, nodes));
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
        reader_(data, budget_, source_),
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
    // Triangles are charged although they take no memory here: code that transforms them to world space needs ten times
    // as much.
    constexpr std::uint64_t least_cost = 4;
    budget_.charge(copies * scene_.meshes[instance.mesh].triangles.size(), least_cost, node.place, source_);
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
    // Each node stores and compares weights, even those that come from its mesh.
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
    Mesh posed = reader_.read(plans_[mesh], pose, is_read_[mesh] ? repeated : scene_.warnings);
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

  /// EXT_mesh_gpu_instancing: adds one instance for each element of its attributes.
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
  MeshReader reader_;
  std::vector<Skin> skins_;
  std::vector<bool> is_read_;
  std::map<Key, std::uint32_t> posed_;
};

/// A camera looks along its node's -z, with y up. Cameras have no scale, so the axes are made orthonormal again.
std::optional<glm::dmat4> rigid(const glm::dmat4& world) {
  const glm::dvec3 back(world[2]), up(world[1]);
  // The viewing direction is kept exactly and up is adjusted, because a sheared parent leaves them at an angle.
  const glm::dvec3 right = glm::cross(up, back);
  const double back_length = glm::length(back), right_length = glm::length(right);
  if (!(back_length > 0) || !(right_length > 0)) return std::nullopt;
  const glm::dvec3 z = back / back_length, x = right / right_length;
  return glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), world[3]);
}

std::optional<double> positive(const JsonValue& json, const char* key) {
  const double value = json.number_or(key, 0);
  return value > 0 ? std::optional(value) : std::nullopt;
}

/// The lens of a camera. Empty for unknown types, and for sizes that are not positive.
std::optional<Camera> read_camera(const JsonValue& json) {
  Camera camera;
  camera.name = json.name();
  camera.orthographic = json.require("type").to_string() == "orthographic";
  const std::optional<JsonValue> lens = json.find(camera.orthographic ? "orthographic" : "perspective");
  if (!lens) return std::nullopt;
  camera.near = positive(*lens, "znear");
  camera.far = positive(*lens, "zfar");
  if (camera.orthographic) {
    const auto half_width = positive(*lens, "xmag"), half_height = positive(*lens, "ymag");
    if (!half_width || !half_height) return std::nullopt;
    camera.vertical = 2 * *half_height;
    camera.aspect = *half_width / *half_height;
    return camera;
  }
  const auto angle = positive(*lens, "yfov");
  constexpr double straight = 3.14159265358979;
  if (!angle || *angle >= straight) return std::nullopt;
  camera.vertical = *angle;
  camera.aspect = positive(*lens, "aspectRatio");
  return camera;
}

}  // namespace

void place_meshes(const JsonValue& root, const Data& data, const std::vector<MeshPlan>& plans, const NodeTree& tree,
                  Scene& scene) {
  PosedMeshes(root, data, plans, tree, scene).place();
}

void place_cameras(const JsonValue& root, const NodeTree& tree, Scene& scene) {
  for (const std::uint32_t id : tree.shown) {
    const Node& node = tree.nodes[id];
    if (node.camera == no_index) continue;
    const JsonValue json = root.require("cameras")[node.camera];
    std::optional<Camera> camera = read_camera(json);
    const std::optional<glm::dmat4> pose = rigid(node.world);
    if (!camera || !pose) {
      scene.warnings.push_back((camera ? node.place : json.place()) + ": a camera that sees nothing is left out");
      continue;
    }
    camera->world_from_eye = *pose;
    if (!node.name.empty()) camera->name = node.name;
    scene.cameras.push_back(*std::move(camera));
  }
}

}  // namespace frontmost::gltf
