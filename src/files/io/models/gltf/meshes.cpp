// SPDX-License-Identifier: Apache-2.0
// Turns a mesh of the file into one Mesh: all its primitives in order, with vertices moved by morph targets and joints.
//
// Exporters let primitives, and whole meshes, share one large array of vertices, which must not be stored repeatedly.
// So triangles are read first, to find the range of vertices that each block of primitives uses, which alone is read.
#include <algorithm>
#include <bit>
#include <numeric>

#include "io/models/gltf/nodes.h"
#include "io/models/mesh_building.h"

namespace frontmost::gltf {
namespace {

/// A run of a mesh's vertices that come from one vertex set.
struct VertexRun {
  const VertexSet* vertices = nullptr;
  ElementRange range;     ///< range of the accessors' elements; empty if no triangle uses the run
  std::size_t first = 0;  ///< first vertex in the mesh
  std::string place;      ///< place of the first primitive that uses the run
};

/// Returns the values of a set of texture coordinates. Creates the set if it is absent.
std::vector<glm::vec2>& texcoords_of(Mesh& mesh, std::size_t set) {
  if (set == 0) return mesh.texcoords.values;
  if (mesh.further_texcoords.size() < set) mesh.further_texcoords.resize(set);
  return mesh.further_texcoords[set - 1].values;
}

/// Adds `weight` times the displacements of a morph target to the values of a run.
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

  /// The weighted mean of the joints' matrices. Weights stored as bytes may not sum to one, so the sum is divided out.
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

/// Returns the inverse transpose up to a positive factor. It also exists for singular matrices.
glm::dmat3 normal_matrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::dot(m[0], cofactors[0]) < 0 ? -cofactors : cofactors;
}

/// Adds weighted displacements to positions, normals, texture coordinates and colours.
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

/// Moves positions and normals by joints. Precondition: the block's vertices have joints.
/// \throws Error file_malformed for a joint that the skin does not have.
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

/// Builds one mesh.
class MeshBuilder {
 public:
  MeshBuilder(const MeshPlan& plan, const Data& data, Budget& budget, const ModelSource& source)
      : plan_(plan), data_(data), budget_(budget), source_(source) {
    mesh_.name = plan.name;
  }

  Mesh build(const VertexPose& pose, std::vector<std::string>& warnings) {
    for (const Primitive& primitive : plan_.primitives) append_triangles(primitive, warnings);
    for (const Primitive& lines : plan_.edges) append_edges(lines);
    place_blocks();
    std::size_t triangle = 0;
    for (const Run& run : runs_)
      for (const std::size_t end = triangle + run.triangle_count; triangle < end; ++triangle)
        mesh_.triangles[triangle] += shift_of(run.block);
    for (const EdgeRun& run : edge_runs_)
      for (std::size_t i = run.first; i < run.end; ++i) (*run.edges)[i] += shift_of(run.block);
    for (const VertexRun& block : blocks_) read_vertices(block, pose);
    // A pose moves vertices off their circles.
    if (!pose.joints.empty() || !pose.weights.empty()) mesh_.edge_circles.clear();
    return std::move(mesh_);
  }

 private:
  /// The triangles of one primitive.
  struct Run {
    std::size_t block, triangle_count;
  };
  /// The edges of one primitive.
  struct EdgeRun {
    std::size_t block;
    std::vector<glm::uvec2>* edges;
    std::size_t first, end;
  };

  /// What is added to a primitive's vertex numbers. The sum is right even if the shift wraps around, because the block
  /// starts earlier in the mesh than in the accessor.
  [[nodiscard]] std::uint32_t shift_of(std::size_t block) const {
    return std::uint32_t(blocks_[block].first - blocks_[block].range.first);
  }

  void append_triangles(const Primitive& primitive, std::vector<std::string>& warnings) {
    const std::size_t corner_count =
        primitive.indices != no_index ? data_.accessor(primitive.indices).count : primitive.vertex_count;
    const bool is_list = primitive.mode == Mode::triangles;
    const std::size_t count = is_list ? corner_count / 3 : std::max<std::size_t>(corner_count, 2) - 2;
    if (is_list && corner_count % 3 != 0) warnings.push_back(primitive.place + ": the last triangle is incomplete");
    budget_.charge(count, sizeof(glm::uvec3) + sizeof(std::uint32_t), primitive.place, source_);
    const std::size_t first = mesh_.triangles.size();
    mesh_.triangles.resize(first + count);
    const std::span<glm::uvec3> triangles(mesh_.triangles.data() + first, count);
    if (is_list)
      read_corners(primitive, {0, 3 * count}, count == 0 ? nullptr : &triangles[0][0]);
    else
      read_strip_or_fan(primitive, corner_count, triangles);
    append_material(mesh_.material_ids, first, count, primitive.material);
    // A primitive without triangles has a run, too, so that runs and primitives have equal numbers.
    runs_.push_back({include(primitive, {count == 0 ? nullptr : &triangles[0].x, 3 * count}, 3), count});
  }

  void append_edges(const Primitive& lines) {
    std::size_t count = lines.indices != no_index ? data_.accessor(lines.indices).count : lines.vertex_count;
    budget_.charge(count, sizeof(glm::uvec2) + sizeof(std::uint32_t), lines.place, source_);
    std::vector<std::uint32_t> ends(count);
    read_corners(lines, {0, count}, ends.data());
    if (lines.mode == Mode::line_loop && count > 0) ends.push_back(ends.front());
    std::vector<glm::uvec2>& edges = lines.is_smooth ? mesh_.smooth_edges : mesh_.sharp_edges;
    const std::size_t first = edges.size();
    for (std::size_t i = 1; i < ends.size(); i += lines.mode == Mode::lines ? 2 : 1)
      edges.emplace_back(ends[i - 1], ends[i]);
    edge_runs_.push_back({include(lines, ends, 2), &edges, first, edges.size()});
    for (EdgeCircle circle : lines.circles) {
      const std::size_t own = edges.size() - first;
      if (lines.is_smooth || circle.first > own || circle.count > own - circle.first)
        source_.fail(lines.place, "a circle names edges that do not exist, or smooth ones");
      circle.first += std::uint32_t(first);
      mesh_.edge_circles.push_back(circle);
    }
  }

  void read_corners(const Primitive& primitive, ElementRange range, std::uint32_t* out) const {
    if (primitive.indices != no_index)
      read_integers(data_.accessor(primitive.indices), range, 1, out);
    else
      std::iota(out, out + range.count, std::uint32_t(range.first));
  }

  /// Takes corners in the format's order for each mode, which keeps the winding of a strip's odd triangles.
  void read_strip_or_fan(const Primitive& primitive, std::size_t corner_count, std::span<glm::uvec3> triangles) const {
    if (triangles.empty()) return;
    budget_.charge(corner_count, sizeof(std::uint32_t), primitive.place, source_);
    std::vector<std::uint32_t> corners(corner_count);
    read_corners(primitive, {0, corner_count}, corners.data());
    for (std::size_t i = 0; i < triangles.size(); ++i)
      triangles[i] = primitive.mode == Mode::fan
                         ? glm::uvec3(corners[i + 1], corners[i + 2], corners[0])
                         : glm::uvec3(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
  }

  /// Checks vertex numbers and widens the range of needed vertices. `width`: vertices of a triangle or an edge.
  /// \returns the primitive's block.
  std::size_t include(const Primitive& primitive, std::span<const std::uint32_t> vertices, std::size_t width) {
    std::uint32_t least = no_index, greatest = 0;
    for (const std::uint32_t vertex : vertices) {
      least = std::min(least, vertex);
      greatest = std::max(greatest, vertex);
    }
    if (!vertices.empty() && greatest >= primitive.vertex_count) fail_index(primitive, vertices, width);
    const std::size_t block_id = block_of(primitive);
    if (vertices.empty()) return block_id;
    ElementRange& range = blocks_[block_id].range;
    const std::size_t end = std::max(range.first + range.count, std::size_t(greatest) + 1);
    range.first = range.count == 0 ? least : std::min<std::size_t>(range.first, least);
    range.count = end - range.first;
    return block_id;
  }

  [[noreturn]] void fail_index(const Primitive& primitive, std::span<const std::uint32_t> vertices,
                               std::size_t width) const {
    std::size_t i = 0;
    while (vertices[i] < primitive.vertex_count) ++i;
    source_.fail(primitive.place + ".indices", (width == 3 ? "triangle " : "edge ") + std::to_string(i / width) +
                                                   ": vertex " + std::to_string(vertices[i]) +
                                                   " does not exist, there are " +
                                                   std::to_string(primitive.vertex_count));
  }

  std::size_t block_of(const Primitive& primitive) {
    const auto [found, is_new] = block_numbers_.emplace(primitive.vertices, blocks_.size());
    if (is_new) blocks_.push_back({&found->first, {}, 0, primitive.place});
    return found->second;
  }

  /// Assigns each block its place in the mesh and allocates the arrays.
  void place_blocks() {
    std::size_t total = 0;
    bool normals = false, colors = false;
    std::uint32_t sets = 0;
    for (VertexRun& block : blocks_) {
      const VertexSources& base = block.vertices->base;
      block.first = total;
      total += block.range.count;
      normals |= base.normal != no_index;
      for (std::uint32_t set = 0; set < max_texcoord_sets; ++set)
        if (base.texcoords[set] != no_index) sets |= plan_.texcoord_sets & 1u << set;
      colors |= base.color != no_index;
    }
    const std::size_t size = 12 + 12 * normals + 8 * std::size_t(std::popcount(sets)) + 16 * colors;
    budget_.charge(total, size, plan_.place, source_);
    if (total >= no_index) source_.fail_limit(plan_.place, "too many vertices");
    mesh_.positions.resize(total);
    // Default values for primitives without an attribute that another primitive has: no normal, texture coordinates 0,
    // white.
    if (normals) mesh_.normals.values.resize(total, glm::vec3(0));
    for (std::uint32_t set = 0; set < max_texcoord_sets; ++set)
      if (sets >> set & 1) texcoords_of(mesh_, set).resize(total, glm::vec2(0));
    if (colors) mesh_.colors.values.resize(total, glm::vec4(1));
  }

  template <class V>
  void read_attribute(const VertexRun& block, std::uint32_t accessor, std::vector<V>& values) const {
    if (accessor != no_index) read_floats(data_.accessor(accessor), block.range, V::length(), &values[block.first][0]);
  }

  void read_vertices(const VertexRun& block, const VertexPose& pose) {
    if (block.range.count == 0) return;
    const VertexSources& base = block.vertices->base;
    read_attribute(block, base.position, mesh_.positions);
    read_attribute(block, base.normal, mesh_.normals.values);
    for (std::uint32_t set = 0; set < max_texcoord_sets; ++set)
      if (mesh_.texcoord_set(set)) read_attribute(block, base.texcoords[set], texcoords_of(mesh_, set));
    read_attribute(block, base.color, mesh_.colors.values);
    charge_pose(block, pose);
    apply_targets(data_, block, pose.weights, mesh_);
    if (block.vertices->joints.empty())
      take_off(pose.origin, block);
    else
      apply_skin(data_, block, pose.joints, source_, mesh_);
  }

  /// Subtracts the skin's origin from the vertices of a block without joints, so that they stay where the mesh is.
  /// Primitives of one mesh need not all have joints.
  void take_off(const glm::dvec3& origin, const VertexRun& block) {
    if (origin == glm::dvec3(0)) return;
    for (std::size_t i = block.first; i < block.first + block.range.count; ++i)
      mesh_.positions[i] = glm::vec3(glm::dvec3(mesh_.positions[i]) - origin);
  }

  /// Charges the budget for the work of a pose. Posing takes no memory, but many targets of many vertices would take
  /// too long.
  void charge_pose(const VertexRun& block, const VertexPose& pose) {
    const auto targets =
        std::size_t(std::count_if(pose.weights.begin(), pose.weights.end(), [](double w) { return w != 0; }));
    const std::size_t passes = targets + (pose.joints.empty() ? 0 : block.vertices->joints.size());
    if (passes != 0) budget_.charge(block.range.count, passes * sizeof(glm::vec4), block.place, source_);
  }

  const MeshPlan& plan_;
  const Data& data_;
  Budget& budget_;
  const ModelSource& source_;
  Mesh mesh_;
  std::vector<Run> runs_;
  std::vector<EdgeRun> edge_runs_;
  std::vector<VertexRun> blocks_;
  std::map<VertexSet, std::size_t> block_numbers_;
};

}  // namespace

Mesh read_mesh(const MeshPlan& plan, const VertexPose& pose, const Data& data, Budget& budget,
               const ModelSource& source, std::vector<std::string>& warnings) {
  return MeshBuilder(plan, data, budget, source).build(pose, warnings);
}

}  // namespace frontmost::gltf
