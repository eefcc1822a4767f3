// SPDX-License-Identifier: Apache-2.0
// Cuts triangles, in spatial order, into clusters of at most 64 distinct vertices.
//
// Vertices are told apart by position, not by number: in a soup, as STL files are, every corner has a number of its
// own, and welding inside a cluster doubles what it holds. Work is split at fixed places of the order, so the clusters
// do not depend on the number of threads.

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "base/parallel.h"
#include "surfaces/cluster_set.h"
#include "surfaces/spatial_order.h"

namespace frontmost {
namespace {

constexpr std::uint32_t kTrianglesPerPart = 1u << 14;

constexpr std::size_t padded(std::size_t count) {
  return (count + Cluster::lanes - 1) / Cluster::lanes * Cluster::lanes;
}

/// A run of the spatial order, and the clusters made of it.
struct Part {
  std::vector<Cluster> clusters;  // first_vertex and first_triangle relative to the part
  std::vector<Box> boxes;
  std::vector<float> x, y, z;
  std::array<std::vector<std::uint8_t>, 3> corners;
  std::vector<PrimitiveId> id;
  std::vector<std::pair<std::uint32_t, Box>> instance_boxes;  // of runs of one instance's triangles
};

/// Which of a cluster's vertices a position is: a small open-addressing table over the bits of the coordinates.
/// Keying by position serves indexed meshes and soups alike.
class VertexTable {
 public:
  void clear() {
    slots_.fill(kFree);
    count_ = 0;
  }
  [[nodiscard]] int size() const { return count_; }

  [[nodiscard]] bool holds(const glm::vec3& p) const { return slots_[slot_of(p)] != kFree; }
  /// The vertex's number; it is added when it is not in the table yet. Precondition: there is room.
  int intern(const glm::vec3& p) {
    std::uint8_t& slot = slots_[slot_of(p)];
    if (slot == kFree) {
      positions_[std::size_t(count_)] = p;
      slot = static_cast<std::uint8_t>(count_++);
    }
    return slot;
  }
  [[nodiscard]] const glm::vec3& operator[](int i) const { return positions_[std::size_t(i)]; }

 private:
  static constexpr std::uint32_t kSlots = 256;
  static constexpr std::uint8_t kFree = 0xFF;

  /// Where the position is, or belongs.
  [[nodiscard]] std::uint32_t slot_of(const glm::vec3& p) const {
    std::uint32_t slot = hash(p);
    while (slots_[slot] != kFree && !same_bits(positions_[slots_[slot]], p)) slot = (slot + 1) % kSlots;
    return slot;
  }
  static bool same_bits(const glm::vec3& a, const glm::vec3& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
  static std::uint32_t hash(const glm::vec3& p) {
    std::array<std::uint32_t, 3> bits;
    std::memcpy(bits.data(), &p, sizeof bits);
    const std::uint32_t mixed = (bits[0] * 0x9E3779B1u) ^ (bits[1] * 0x85EBCA77u) ^ (bits[2] * 0xC2B2AE3Du);
    return (mixed ^ (mixed >> 15)) * 0x2C1B3C6Du >> 24;
  }

  std::array<std::uint8_t, kSlots> slots_;
  std::array<glm::vec3, Cluster::max_vertices> positions_;
  int count_ = 0;
};

/// What all parts are made from.
struct Source {
  const Scene& scene;
  const std::vector<PrimitiveId>& first_primitives;
  const InstanceFinder& instances;
  const std::vector<PrimitiveId>& order;
  const std::vector<std::uint8_t>& mirrored;
};

/// Fills one part, cluster by cluster.
class PartBuilder {
 public:
  PartBuilder(const Source& source, Part& part) : source_(source), part_(part) {}

  void build(std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    for (std::vector<std::uint8_t>& corners : part_.corners) corners.reserve(count + count / 4);
    for (auto* axis : {&part_.x, &part_.y, &part_.z}) axis->reserve(count);
    part_.id.reserve(count + count / 4);
    start_cluster();
    for (std::size_t i = begin; i < end; ++i) {
      prefetch(i, end);
      add(source_.order[i]);
    }
    finish_cluster();
  }

 private:
  void start_cluster() {
    table_.clear();
    box_ = {};
    cluster_ = {};
    cluster_.first_vertex = part_.x.size();
    cluster_.first_triangle = part_.id.size();
  }

  /// Triangles that are neighbours in space are often far apart in memory: the corner numbers are asked for well
  /// ahead, and the positions that they lead to a little later.
  void prefetch(std::size_t i, std::size_t end) const {
    constexpr std::size_t kCornersAhead = 24, kPositionsAhead = 12;
    if (i + kCornersAhead >= end) return;
    __builtin_prefetch(&corners_of(source_.order[i + kCornersAhead]));
    const PrimitiveId id = source_.order[i + kPositionsAhead];
    const Mesh& mesh = source_.scene.meshes[source_.scene.instances[source_.instances.find(id)].mesh];
    const glm::uvec3& corners = corners_of(id);
    for (int k = 0; k < 3; ++k) __builtin_prefetch(&mesh.positions[corners[k]]);
  }

  [[nodiscard]] const glm::uvec3& corners_of(PrimitiveId id) const {
    const std::uint32_t instance = source_.instances.find(id);
    return source_.scene.meshes[source_.scene.instances[instance].mesh]
        .triangles[id - source_.first_primitives[instance]];
  }

  void add(PrimitiveId id) {
    const std::uint32_t number = source_.instances.find(id);
    const Instance& instance = source_.scene.instances[number];
    const Mesh& mesh = source_.scene.meshes[instance.mesh];
    const ToWorld to_world_space(instance.world_from_mesh);
    const glm::uvec3& corners = mesh.triangles[id - source_.first_primitives[number]];
    std::array<glm::vec3, 3> world;
    bool finite = true;
    for (int k = 0; k < 3; ++k) {
      world[std::size_t(k)] = to_world_space(mesh.positions[corners[k]]);
      finite = finite && is_finite(world[std::size_t(k)]);
    }
    if (cluster_.triangle_count == Cluster::max_triangles || (finite && !fits(world))) {
      finish_cluster();
      start_cluster();
    }
    // Not finite: degenerate, three times vertex 0, whatever that is or will be.
    const std::size_t t = cluster_.triangle_count++;
    for (std::size_t k = 0; k < 3; ++k)
      corners_[k][t] = finite ? static_cast<std::uint8_t>(table_.intern(world[k])) : std::uint8_t(0);
    // A mirror turns counter-clockwise into clockwise, but what was outside stays outside.
    if (source_.mirrored[number]) std::swap(corners_[1][t], corners_[2][t]);
    part_.id.push_back(id);
    if (finite) include(number, world);
  }

  void include(std::uint32_t instance, const std::array<glm::vec3, 3>& world) {
    if (part_.instance_boxes.empty() || part_.instance_boxes.back().first != instance)
      part_.instance_boxes.emplace_back(instance, Box{});
    const Box triangle{glm::min(glm::min(world[0], world[1]), world[2]),
                       glm::max(glm::max(world[0], world[1]), world[2])};
    box_.include(triangle);
    part_.instance_boxes.back().second.include(triangle);
  }

  [[nodiscard]] bool fits(const std::array<glm::vec3, 3>& world) const {
    if (table_.size() + 3 <= Cluster::max_vertices) return true;
    int missing = 0;
    for (const glm::vec3& p : world) missing += !table_.holds(p);
    return table_.size() + missing <= Cluster::max_vertices;
  }

  void finish_cluster() {
    if (cluster_.triangle_count == 0) return;
    cluster_.vertex_count = static_cast<std::uint16_t>(table_.size());
    const int last = table_.size() - 1;
    for (int i = 0; i < int(padded(std::size_t(table_.size()))); ++i) {
      const glm::vec3& p = table_[std::min(i, last)];
      part_.x.push_back(p.x);
      part_.y.push_back(p.y);
      part_.z.push_back(p.z);
    }
    const std::size_t end = cluster_.first_triangle + padded(cluster_.triangle_count);
    for (std::size_t k = 0; k < 3; ++k) {
      part_.corners[k].insert(part_.corners[k].end(), corners_[k].begin(),
                              corners_[k].begin() + cluster_.triangle_count);
      part_.corners[k].resize(end, 0);
    }
    part_.id.resize(end, no_primitive);
    part_.clusters.push_back(cluster_);
    part_.boxes.push_back(box_);
  }

  const Source& source_;
  Part& part_;
  VertexTable table_;
  Cluster cluster_;
  std::array<std::array<std::uint8_t, Cluster::max_triangles>, 3> corners_;
  Box box_;
};

/// Where each part's clusters, vertices and triangles go in the whole.
struct Place {
  std::size_t cluster = 0, vertex = 0, triangle = 0;
};

template <class T>
void place(const std::vector<T>& part, Buffer<T>& whole, std::size_t at) {
  std::copy(part.begin(), part.end(), whole.data() + at);
}

void gather(ClusterSet& set, std::vector<Part>& parts, const Execution& execution) {
  std::vector<Place> places(parts.size() + 1);
  for (std::size_t i = 0; i < parts.size(); ++i)
    places[i + 1] = {places[i].cluster + parts[i].clusters.size(), places[i].vertex + parts[i].x.size(),
                     places[i].triangle + parts[i].id.size()};
  const Place& total = places.back();
  set.clusters.resize(total.cluster);
  set.boxes = BoxArrays(total.cluster);
  for (Buffer<float>* axis : {&set.x, &set.y, &set.z}) *axis = Buffer<float>(total.vertex);
  for (Buffer<std::uint8_t>* corners : {&set.i0, &set.i1, &set.i2}) *corners = Buffer<std::uint8_t>(total.triangle);
  set.id = Buffer<PrimitiveId>(total.triangle);

  parallel_for(execution, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Part part = std::move(parts[i]);
      const Place& at = places[i];
      place(part.x, set.x, at.vertex);
      place(part.y, set.y, at.vertex);
      place(part.z, set.z, at.vertex);
      place(part.corners[0], set.i0, at.triangle);
      place(part.corners[1], set.i1, at.triangle);
      place(part.corners[2], set.i2, at.triangle);
      place(part.id, set.id, at.triangle);
      for (std::size_t c = 0; c < part.clusters.size(); ++c) {
        Cluster cluster = part.clusters[c];
        cluster.first_vertex += at.vertex;
        cluster.first_triangle += at.triangle;
        set.clusters[at.cluster + c] = cluster;
        set.boxes.set(at.cluster + c, part.boxes[c]);
      }
    }
  });
}

}  // namespace

BoxArrays::BoxArrays(std::size_t count) {
  for (Buffer<float>* low : {&low_x, &low_y, &low_z})
    *low = Buffer<float>(padded(count), std::numeric_limits<float>::infinity());
  for (Buffer<float>* high : {&high_x, &high_y, &high_z})
    *high = Buffer<float>(padded(count), -std::numeric_limits<float>::infinity());
}

void BoxArrays::set(std::size_t i, const Box& box) {
  low_x[i] = box.low.x, low_y[i] = box.low.y, low_z[i] = box.low.z;
  high_x[i] = box.high.x, high_y[i] = box.high.y, high_z[i] = box.high.z;
}

ClusterSet build_clusters(const Scene& scene, const Execution& execution) {
  ClusterSet set;
  set.scene = &scene;
  set.first_primitives.push_back(0);
  for (const Instance& instance : scene.instances)
    set.first_primitives.push_back(set.first_primitives.back() +
                                   static_cast<PrimitiveId>(scene.meshes[instance.mesh].triangles.size()));

  // The fractions are about what the steps take of the time.
  for (const Instance& instance : scene.instances)
    set.mirrored.push_back(glm::determinant(glm::dmat3(instance.world_from_mesh)) < 0);
  const std::vector<PrimitiveId> order = spatial_order(scene, set.first_primitives, execution);
  report_progress(execution, "surfaces", 0.4);
  const InstanceFinder instances(set.first_primitives);
  const Source source{scene, set.first_primitives, instances, order, set.mirrored};
  std::vector<Part> parts((order.size() + kTrianglesPerPart - 1) / kTrianglesPerPart);
  parallel_for(execution, order.size(), kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
    PartBuilder(source, parts[begin / kTrianglesPerPart]).build(begin, end);
  });
  report_progress(execution, "surfaces", 0.9);
  set.instance_bounds.resize(scene.instances.size());
  for (const Part& part : parts)
    for (const auto& [instance, box] : part.instance_boxes) set.instance_bounds[instance].include(box);
  for (const Box& box : set.instance_bounds) set.bounds.include(box);
  gather(set, parts, execution);
  report_progress(execution, "surfaces", 1);
  return set;
}

}  // namespace frontmost
