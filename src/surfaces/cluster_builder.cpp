// SPDX-License-Identifier: Apache-2.0
// Cuts triangles, in the order of their ids, into clusters of at most 64 distinct vertices.
//
// A vertex is told apart by its number in the mesh or, in a soup where every corner has a number of its own, by its
// position: consecutive STL facets share most corners, and welding them inside a cluster doubles what it holds.
// Work is split at fixed triangle numbers, so the clusters do not depend on the number of threads.

#include <algorithm>
#include <array>
#include <cstring>

#include "base/parallel.h"
#include "surfaces/cluster_set.h"

namespace frontmost {
namespace {

constexpr std::uint32_t kTrianglesPerPart = 1u << 14;

constexpr std::size_t padded(std::size_t count) {
  return (count + Cluster::lanes - 1) / Cluster::lanes * Cluster::lanes;
}

/// A run of one instance's triangles, and the clusters made of it.
struct Part {
  std::uint32_t instance = 0;
  std::uint32_t begin = 0, end = 0;
  PrimitiveId first_primitive = 0;

  std::vector<Cluster> clusters;  // first_vertex and first_corner relative to the part
  std::vector<Box> boxes;
  std::vector<float> x, y, z;
  std::vector<std::uint8_t> i0, i1, i2;
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

  /// The vertex's number, or -1 when it is not in the table.
  [[nodiscard]] int find(const glm::vec3& p) const {
    for (std::uint32_t slot = hash(p);; slot = (slot + 1) % kSlots) {
      if (slots_[slot] == kFree) return -1;
      if (same_bits(positions_[slots_[slot]], p)) return slots_[slot];
    }
  }
  int add(const glm::vec3& p) {
    std::uint32_t slot = hash(p);
    while (slots_[slot] != kFree) slot = (slot + 1) % kSlots;
    positions_[std::size_t(count_)] = p;
    slots_[slot] = static_cast<std::uint8_t>(count_);
    return count_++;
  }
  [[nodiscard]] const glm::vec3& operator[](int i) const { return positions_[std::size_t(i)]; }

 private:
  static constexpr std::uint32_t kSlots = 256;
  static constexpr std::uint8_t kFree = 0xFF;

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

/// Fills one part, cluster by cluster.
class PartBuilder {
 public:
  PartBuilder(const Scene& scene, Part& part)
      : part_(part),
        mesh_(scene.meshes[scene.instances[part.instance].mesh]),
        world_from_mesh_(scene.instances[part.instance].world_from_mesh) {
    table_.clear();
  }

  void build() {
    const std::size_t count = part_.end - part_.begin;
    for (auto* corners : {&part_.i0, &part_.i1, &part_.i2}) corners->reserve(count + count / 8 + Cluster::lanes);
    for (auto* axis : {&part_.x, &part_.y, &part_.z}) axis->reserve(count);
    start_cluster(part_.begin);
    for (std::uint32_t t = part_.begin; t < part_.end; ++t) add(t);
    finish_cluster();
  }

 private:
  void start_cluster(std::uint32_t triangle) {
    table_.clear();
    box_ = {};
    cluster_ = {};
    cluster_.first_vertex = part_.x.size();
    cluster_.first_corner = part_.i0.size();
    cluster_.first_primitive = part_.first_primitive + (triangle - part_.begin);
  }

  void add(std::uint32_t triangle) {
    const glm::uvec3& corners = mesh_.triangles[triangle];
    std::array<glm::vec3, 3> world;
    bool finite = true;
    for (int k = 0; k < 3; ++k) {
      world[std::size_t(k)] = to_world(world_from_mesh_, mesh_.positions[corners[k]]);
      finite = finite && is_finite(world[std::size_t(k)]);
    }
    if (cluster_.triangle_count == Cluster::max_triangles || (finite && !fits(world))) {
      finish_cluster();
      start_cluster(triangle);
    }
    // Not finite: degenerate, three times vertex 0, whatever that is or will be.
    std::array<std::uint8_t, 3> numbers{};
    for (std::size_t k = 0; finite && k < 3; ++k) {
      const int found = table_.find(world[k]);
      numbers[k] = static_cast<std::uint8_t>(found >= 0 ? found : table_.add(world[k]));
      box_.include(world[k]);
    }
    part_.i0.push_back(numbers[0]);
    part_.i1.push_back(numbers[1]);
    part_.i2.push_back(numbers[2]);
    ++cluster_.triangle_count;
  }

  [[nodiscard]] bool fits(const std::array<glm::vec3, 3>& world) const {
    if (table_.size() + 3 <= Cluster::max_vertices) return true;
    int missing = 0;
    for (const glm::vec3& p : world) missing += table_.find(p) < 0;
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
    for (auto* corners : {&part_.i0, &part_.i1, &part_.i2})
      corners->resize(cluster_.first_corner + padded(cluster_.triangle_count), 0);
    part_.clusters.push_back(cluster_);
    part_.boxes.push_back(box_);
  }

  Part& part_;
  const Mesh& mesh_;
  const glm::dmat4& world_from_mesh_;
  VertexTable table_;
  Cluster cluster_;
  Box box_;
};

std::vector<Part> split(const Scene& scene, const std::vector<PrimitiveId>& first_primitives) {
  std::vector<Part> parts;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const auto count = static_cast<std::uint32_t>(scene.meshes[scene.instances[i].mesh].triangles.size());
    for (std::uint64_t begin = 0; begin < count; begin += kTrianglesPerPart) {
      Part part;
      part.instance = i;
      part.begin = static_cast<std::uint32_t>(begin);
      part.end = static_cast<std::uint32_t>(std::min<std::uint64_t>(begin + kTrianglesPerPart, count));
      part.first_primitive = first_primitives[i] + part.begin;
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

/// Where each part's clusters, vertices and corners go in the whole.
struct Place {
  std::size_t cluster = 0, vertex = 0, corner = 0;
};

void gather(ClusterSet& set, std::vector<Part>& parts, const Execution& execution) {
  std::vector<Place> places(parts.size() + 1);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    places[i + 1] = {places[i].cluster + parts[i].clusters.size(), places[i].vertex + parts[i].x.size(),
                     places[i].corner + parts[i].i0.size()};
    for (const Box& box : parts[i].boxes) set.instance_bounds[parts[i].instance].include(box);
  }
  const Place& total = places.back();
  set.clusters.resize(total.cluster);
  set.boxes = BoxArrays(total.cluster);
  for (Buffer<float>* axis : {&set.x, &set.y, &set.z}) *axis = Buffer<float>(total.vertex);
  for (Buffer<std::uint8_t>* corners : {&set.i0, &set.i1, &set.i2}) *corners = Buffer<std::uint8_t>(total.corner);

  parallel_for(execution, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Part part = std::move(parts[i]);
      const Place& place = places[i];
      std::copy(part.x.begin(), part.x.end(), set.x.data() + place.vertex);
      std::copy(part.y.begin(), part.y.end(), set.y.data() + place.vertex);
      std::copy(part.z.begin(), part.z.end(), set.z.data() + place.vertex);
      std::copy(part.i0.begin(), part.i0.end(), set.i0.data() + place.corner);
      std::copy(part.i1.begin(), part.i1.end(), set.i1.data() + place.corner);
      std::copy(part.i2.begin(), part.i2.end(), set.i2.data() + place.corner);
      for (std::size_t c = 0; c < part.clusters.size(); ++c) {
        Cluster cluster = part.clusters[c];
        cluster.first_vertex += place.vertex;
        cluster.first_corner += place.corner;
        set.clusters[place.cluster + c] = cluster;
        set.boxes.set(place.cluster + c, part.boxes[c]);
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
  set.instance_bounds.resize(scene.instances.size());

  std::vector<Part> parts = split(scene, set.first_primitives);
  parallel_for(execution, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) PartBuilder(scene, parts[i]).build();
  });
  gather(set, parts, execution);
  for (const Box& box : set.instance_bounds) set.bounds.include(box);
  return set;
}

}  // namespace frontmost
