// SPDX-License-Identifier: Apache-2.0
#include "io/models/gltf/meshes.h"

namespace frontmost::gltf {
namespace {

/// values[i] += weight * displacement i.
template <class V>
void add(const Data& data, const VertexRun& block, std::uint32_t accessor, double weight, std::vector<V>& values) {
  // A target may displace what the mesh lacks, for example normals; such displacements are ignored.
  if (accessor == no_index || values.empty()) return;
  std::vector<V> displacements(block.range.count, V(0));
  read_floats(data.accessor(accessor), block.range, V::length(), &displacements[0][0]);
  for (std::size_t i = 0; i < block.range.count; ++i) values[block.first + i] += float(weight) * displacements[i];
}

/// Joints and weights of a block's vertices, all sets of four side by side.
class Influences {
 public:
  Influences(const Data& data, const VertexRun& block, std::size_t joint_count, const ModelSource& source)
      : sets_(block.vertices->joints.size()), width_(4 * sets_) {
    joints_.resize(block.range.count * width_);
    weights_.resize(block.range.count * width_);
    std::vector<std::uint32_t> joints(4 * block.range.count);
    std::vector<float> weights(4 * block.range.count);
    for (std::size_t set = 0; set < sets_; ++set) {
      read_integers(data.accessor(block.vertices->joints[set]), block.range, 4, joints.data());
      read_floats(data.accessor(block.vertices->weights[set]), block.range, 4, weights.data());
      for (std::size_t i = 0; i < joints.size(); ++i) {
        // Unused places often hold rubbish; only joints with a weight must exist.
        if (weights[i] != 0 && joints[i] >= joint_count)
          source.fail(block.place + ".attributes.JOINTS_" + std::to_string(set),
                      "vertex " + std::to_string(block.range.first + i / 4) + " uses joint " +
                          std::to_string(joints[i]) + ", the skin has " + std::to_string(joint_count));
        const std::size_t to = i / 4 * width_ + set * 4 + i % 4;
        joints_[to] = joints[i];
        weights_[to] = weights[i];
      }
    }
  }

  /// The weighted mean of the joints' matrices. Weights stored as bytes may not sum to exactly one, so the sum is
  /// divided out.
  [[nodiscard]] glm::dmat4 matrix(std::size_t vertex, std::span<const glm::dmat4> joints) const {
    glm::dmat4 sum(0.0);
    double total = 0;
    for (std::size_t k = vertex * width_; k < (vertex + 1) * width_; ++k) {
      if (weights_[k] == 0) continue;
      sum += joints[joints_[k]] * double(weights_[k]);
      total += double(weights_[k]);
    }
    // A vertex without weight would fall into the world's origin; with the first joint it stays near the body.
    return total != 0 ? sum / total : joints.front();
  }

 private:
  std::size_t sets_, width_;
  std::vector<std::uint32_t> joints_;
  std::vector<float> weights_;
};

/// The inverse transpose up to a positive factor. It also exists for singular matrices.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::dot(m[0], cofactors[0]) < 0 ? -cofactors : cofactors;
}

}  // namespace

void apply_targets(const Data& data, const VertexRun& block, std::span<const double> weights, Mesh& mesh) {
  const VertexSet& vertices = *block.vertices;
  for (std::size_t i = 0; i < weights.size() && i < vertices.targets.size(); ++i) {
    if (weights[i] == 0) continue;
    const VertexSources& target = vertices.targets[i];
    add(data, block, target.position, weights[i], mesh.positions);
    add(data, block, target.normal, weights[i], mesh.normals.values);
    for (std::uint32_t set = 0; set < max_texcoord_sets; ++set)
      if (mesh.texcoord_set(set)) add(data, block, target.texcoords[set], weights[i], texcoords_of(mesh, set));
    add(data, block, target.color, weights[i], mesh.colors.values);
  }
}

void apply_skin(const Data& data, const VertexRun& block, std::span<const glm::dmat4> joints, const ModelSource& source,
                Mesh& mesh) {
  if (joints.empty()) return;
  const Influences influences(data, block, joints.size(), source);
  for (std::size_t i = 0; i < block.range.count; ++i) {
    const glm::dmat4 matrix = influences.matrix(i, joints);
    glm::vec3& position = mesh.positions[block.first + i];
    position = glm::vec3(matrix * glm::dvec4(position, 1.0));
    if (mesh.normals.empty()) continue;
    glm::vec3& normal = mesh.normals.values[block.first + i];
    const glm::dvec3 turned = normal_matrix(glm::dmat3(matrix)) * glm::dvec3(normal);
    const double length = glm::length(turned);
    normal = length > 0 ? glm::vec3(turned / length) : glm::vec3(0);
  }
}

}  // namespace frontmost::gltf
