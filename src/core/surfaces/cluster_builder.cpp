// SPDX-License-Identifier: Apache-2.0
// Divides triangles, in spatial order, into clusters of at most 64 distinct vertices.
//
//   spatial order  | t t t t t t t t t t t t t t t t t t t ...
//                  |<- cluster 0 ->|<- cluster 1 ->|      each ends before the first triangle that does not fit
//                  |<----------- part ------------>|      by one thread
//
// Work is split at fixed places of the order, so the clusters do not depend on the number of threads.

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "surfaces/cluster_set.h"
#include "surfaces/spatial_order.h"
#include "surfaces/vertex_table.h"

namespace frontmost {
namespace {

// A part is so large that the short clusters at the ends of parts do not matter, and so small that all threads are kept
// busy.
constexpr std::uint32_t kRunsPerPart = 1u << 13;

/// Some runs of the spatial order, and the clusters made of them. The ids of the clusters' triangles are those of the
/// runs, in order.
struct ClusterPart {
  std::size_t begin = 0;          // first of the runs
  std::vector<Cluster> clusters;  // first_vertex and first_triangle relative to the part
  std::vector<Box> boxes;
  std::vector<float> x, y, z;
  std::array<std::vector<std::uint8_t>, 3> corners;
};

/// The input that all parts share.
struct Source {
  const PlacedScene& placed;
  const InstanceFinder& instances;
  const SpatialOrder& order;
  std::size_t first_cutout;  ///< first run with cutouts; no cluster holds triangles from both sides of it
};

/// The data of an instance for reading its triangles. Neighbours in the order mostly share an instance.
struct Placed {
  std::uint32_t number = 0;
  PrimitiveId first = 0;
  std::uint32_t count = 0;  ///< number of its ids; 0 at first
  const glm::uvec3* triangles = nullptr;
  const glm::vec3* positions = nullptr;

  [[nodiscard]] bool holds(PrimitiveId id) const { return id - first < count; }  // wraps around for lower ids
  [[nodiscard]] const glm::uvec3& corners(PrimitiveId id) const { return triangles[id - first]; }
};

/// Fills one part, cluster by cluster.
class PartBuilder {
 public:
  PartBuilder(const Source& source, ClusterPart& part) : source_(source), part_(part) {}

  void build(std::size_t begin, std::size_t end) {
    const std::size_t count = 2 * (end - begin);
    part_.begin = begin;
    for (std::vector<std::uint8_t>& corners : part_.corners) corners.reserve(count);
    for (auto* axis : {&part_.x, &part_.y, &part_.z}) axis->reserve(count);
    start_cluster();
    for (std::size_t i = begin; i < end; ++i) {
      prefetch(i, end);
      // Triangles with holes are drawn by other code, cluster by cluster, so no cluster may hold triangles of both
      // kinds.
      if (i == source_.first_cutout) start_next_cluster();
      const TriangleRun run = run_at(i);
      for (std::uint32_t k = 0; k < run.count; ++k) add(run.first + k);
    }
    finish_cluster();
  }

 private:
  [[nodiscard]] TriangleRun run_at(std::size_t i) const { return TriangleRun::unpacked(source_.order.runs[i]); }

  void start_cluster() {
    table_.clear();
    cluster_ = {};
    cluster_.first_vertex = part_.x.size();
    cluster_.first_triangle = part_.corners[0].size();
  }

  [[nodiscard]] Placed place_of(PrimitiveId id) const {
    const std::uint32_t number = source_.instances.find(id);
    const Scene& scene = *source_.placed.scene;
    const Mesh& mesh = scene.meshes[scene.instances[number].mesh];
    const std::vector<PrimitiveId>& firsts = source_.placed.first_primitives;
    return {number, firsts[number], firsts[number + 1] - firsts[number], mesh.triangles.data(), mesh.positions.data()};
  }

  /// Runs that are neighbours in space are often far apart in memory. So vertex numbers are prefetched well ahead, and
  /// the positions to which they refer a little later.
  void prefetch(std::size_t i, std::size_t end) const {
    constexpr std::size_t kCornersAhead = 48, kPositionsAhead = 24;
    if (i + kCornersAhead >= end) return;
    const TriangleRun far = run_at(i + kCornersAhead), near = run_at(i + kPositionsAhead);
    const PrimitiveId last = far.first + (far.count - 1);
    const Placed far_place = placed_.holds(far.first) ? placed_ : place_of(far.first);
    prefetch_line(&far_place.corners(far.first));
    prefetch_line(&far_place.corners(last).z);
    const Placed near_place = placed_.holds(near.first) ? placed_ : place_of(near.first);
    for (std::uint32_t t = 0; t < near.count; ++t) {
      const glm::uvec3& corners = near_place.corners(near.first + t);
      for (int k = 0; k < 3; ++k) prefetch_line(&near_place.positions[corners[k]]);
    }
  }

  /// A triangle's vertices.
  struct Corners {
    std::array<VertexKey, 3> key;
    std::array<glm::vec3, 3> world;
  };

  /// \returns whether all vertices are finite in world space.
  bool read(PrimitiveId id, Corners& triangle) {
    if (!placed_.holds(id)) {
      placed_ = place_of(id);
      to_world_.emplace(source_.placed.scene->instances[placed_.number].world_from_mesh);
      // If there is no transform, spatial_order() has already tested the vertices.
      must_check_ = !to_world_->is_identity() || source_.order.all_finite[placed_.number] == 0;
    }
    const glm::uvec3& corners = placed_.corners(id);
    std::array<glm::vec3, 3>& world = triangle.world;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.key[k] = {placed_.positions[corners[int(k)]], placed_.number};
      world[k] = (*to_world_)(triangle.key[k].position);
    }
    return !must_check_ || (is_finite(world[0]) && is_finite(world[1]) && is_finite(world[2]));
  }

  void add(PrimitiveId id) {
    Corners triangle;
    std::array<std::uint8_t, 3> numbers{};  // for vertices that are not finite: degenerate, three times vertex 0
    if (!read(id, triangle)) {
      if (cluster_.triangle_count == Cluster::max_triangles) start_next_cluster();
      append(numbers);
      return;
    }
    if (cluster_.triangle_count == Cluster::max_triangles || !intern_into_rest(triangle, numbers)) {
      start_next_cluster();
      intern(triangle, numbers);
    }
    // A mirror turns counter-clockwise into clockwise, but outer sides stay outer sides.
    if (source_.placed.mirrored[placed_.number]) std::swap(numbers[1], numbers[2]);
    append(numbers);
  }

  void intern(const Corners& triangle, std::array<std::uint8_t, 3>& numbers) {
    for (std::size_t k = 0; k < 3; ++k) numbers[k] = table_.intern(triangle.key[k], triangle.world[k]);
  }

  /// Finds or adds the vertices of a triangle. \returns false, with the table unchanged, if there is not enough room.
  bool intern_into_rest(const Corners& triangle, std::array<std::uint8_t, 3>& numbers) {
    if (table_.size() + 3 <= Cluster::max_vertices) {
      intern(triangle, numbers);
      return true;
    }
    std::size_t missing = 0;
    for (std::size_t k = 0; k < 3; ++k) missing += (numbers[k] = table_.find(triangle.key[k])) == VertexTable::none;
    if (table_.size() + missing > Cluster::max_vertices) return false;
    // Vertices that were found are not looked up again, because adding a vertex may overwrite the guess of another one.
    for (std::size_t k = 0; k < 3; ++k)
      if (numbers[k] == VertexTable::none) numbers[k] = table_.intern(triangle.key[k], triangle.world[k]);
    return true;
  }

  void append(const std::array<std::uint8_t, 3>& numbers) {
    const std::size_t t = cluster_.triangle_count++;
    for (std::size_t k = 0; k < 3; ++k) corners_[k][t] = numbers[k];
  }

  void start_next_cluster() {
    finish_cluster();
    start_cluster();
  }

  void finish_cluster() {
    if (cluster_.triangle_count == 0) return;
    cluster_.vertex_count = static_cast<std::uint16_t>(table_.size());
    // Kernels load whole vectors, so the padding behind the last vertex or triangle must be harmless.
    const std::size_t vertices = table_.pad(), triangles = padded_to_lanes(cluster_.triangle_count);
    part_.x.insert(part_.x.end(), table_.x(), table_.x() + vertices);
    part_.y.insert(part_.y.end(), table_.y(), table_.y() + vertices);
    part_.z.insert(part_.z.end(), table_.z(), table_.z() + vertices);
    for (std::size_t k = 0; k < 3; ++k) {
      std::fill(corners_[k].begin() + cluster_.triangle_count, corners_[k].begin() + triangles, std::uint8_t(0));
      part_.corners[k].insert(part_.corners[k].end(), corners_[k].begin(), corners_[k].begin() + triangles);
    }
    part_.clusters.push_back(cluster_);
    part_.boxes.push_back(table_.bounds());
  }

  const Source& source_;
  ClusterPart& part_;
  Placed placed_;  ///< instance of the last triangle
  std::optional<ToWorld> to_world_;
  bool must_check_ = true;  ///< whether vertices must be tested for being finite
  VertexTable table_;
  Cluster cluster_;
  std::array<std::array<std::uint8_t, padded_to_lanes(Cluster::max_triangles)>, 3> corners_;
};

/// Where the clusters, vertices and triangles of a part begin in the whole set.
struct Place {
  std::size_t cluster = 0, vertex = 0, triangle = 0;
};

template <class T>
void place(const std::vector<T>& part, Buffer<T>& whole, std::size_t at) {
  std::copy(part.begin(), part.end(), whole.data() + at);
}

/// Writes the ids of a part's clusters: the ids of its runs, padded like the triangles.
void place_ids(const ClusterPart& part, const SpatialOrder& order, PrimitiveId* ids) {
  const std::uint64_t* next = order.runs.data() + part.begin;
  TriangleRun run{0, 0};
  for (const Cluster& cluster : part.clusters) {
    PrimitiveId* const first = ids + cluster.first_triangle;
    for (std::size_t t = 0; t < cluster.triangle_count; ++t) {
      if (run.count == 0) run = TriangleRun::unpacked(*next++);
      first[t] = run.first++;
      --run.count;
    }
    std::fill(first + cluster.triangle_count, first + padded_to_lanes(cluster.triangle_count), no_primitive);
  }
}

void gather(ClusterSet& set, std::vector<ClusterPart>& parts, const SpatialOrder& order, const Execution& execution) {
  // All places are known before anything is copied, so parts are copied at the same time and in any order.
  std::vector<Place> places(parts.size() + 1);
  for (std::size_t i = 0; i < parts.size(); ++i)
    places[i + 1] = {places[i].cluster + parts[i].clusters.size(), places[i].vertex + parts[i].x.size(),
                     places[i].triangle + parts[i].corners[0].size()};
  const Place& total = places.back();
  set.clusters.resize(total.cluster);
  set.boxes = BoxArrays(total.cluster);
  for (Buffer<float>* axis : {&set.x, &set.y, &set.z}) *axis = Buffer<float>(total.vertex);
  for (Buffer<std::uint8_t>* corners : {&set.i0, &set.i1, &set.i2}) *corners = Buffer<std::uint8_t>(total.triangle);
  set.id = Buffer<PrimitiveId>(total.triangle);

  parallel_for(execution, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // The part is moved out, so that its memory is freed as soon as it is copied: the whole set never exists twice.
      const ClusterPart part = std::move(parts[i]);
      const Place& at = places[i];
      place(part.x, set.x, at.vertex);
      place(part.y, set.y, at.vertex);
      place(part.z, set.z, at.vertex);
      place(part.corners[0], set.i0, at.triangle);
      place(part.corners[1], set.i1, at.triangle);
      place(part.corners[2], set.i2, at.triangle);
      place_ids(part, order, set.id.data() + at.triangle);
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

/// Moves triangles that may have holes to the end of the order; runs with triangles of both kinds are split. \returns
/// the number of the first run with cutouts.
std::size_t part_cutouts(const Cutouts* cutouts, Buffer<std::uint64_t>& runs) {
  if (!cutouts) return runs.size();
  std::vector<std::uint64_t> kinds[2];
  for (const std::uint64_t bits : runs) {
    const TriangleRun run = TriangleRun::unpacked(bits);
    for (std::uint32_t begin = 0, end; begin < run.count; begin = end) {
      const bool has = cutouts->has(run.first + begin);
      for (end = begin + 1; end < run.count && cutouts->has(run.first + end) == has;) ++end;
      kinds[has].push_back(TriangleRun{run.first + begin, end - begin}.packed(0));
    }
  }
  runs = Buffer<std::uint64_t>(kinds[0].size() + kinds[1].size());
  std::copy(kinds[1].begin(), kinds[1].end(), std::copy(kinds[0].begin(), kinds[0].end(), runs.begin()));
  return kinds[0].size();
}

/// The number of clusters before the cluster whose first triangle is `id`.
std::size_t clusters_before(const ClusterSet& set, PrimitiveId id) {
  std::size_t count = 0;
  while (count < set.clusters.size() && set.id[set.clusters[count].first_triangle] != id) ++count;
  return count;
}

}  // namespace

BoxArrays::BoxArrays(std::size_t count) {
  for (Buffer<float>* low : {&low_x, &low_y, &low_z})
    *low = Buffer<float>(padded_to_lanes(count), std::numeric_limits<float>::infinity());
  for (Buffer<float>* high : {&high_x, &high_y, &high_z})
    *high = Buffer<float>(padded_to_lanes(count), -std::numeric_limits<float>::infinity());
}

void BoxArrays::set(std::size_t i, const Box& box) {
  low_x[i] = box.low.x, low_y[i] = box.low.y, low_z[i] = box.low.z;
  high_x[i] = box.high.x, high_y[i] = box.high.y, high_z[i] = box.high.z;
}

ClusterSet build_clusters(const PlacedScene& placed, const Execution& execution) {
  ClusterSet set;
  set.cutouts = placed.cutouts;
  // The progress fractions are roughly the shares of the time that the steps take.
  SpatialOrder order = spatial_order(placed, execution);
  const std::size_t first_cutout = part_cutouts(set.cutouts.get(), order.runs);
  report_progress(execution, "surfaces", 0.4);
  const InstanceFinder instances(placed.first_primitives);
  const Source source{placed, instances, order, first_cutout};
  std::vector<ClusterPart> parts((order.runs.size() + kRunsPerPart - 1) / kRunsPerPart);
  parallel_for(execution, order.runs.size(), kRunsPerPart, [&](std::size_t begin, std::size_t end) {
    PartBuilder(source, parts[begin / kRunsPerPart]).build(begin, end);
  });
  report_progress(execution, "surfaces", 0.9);
  gather(set, parts, order, execution);
  set.first_cutout = first_cutout < order.runs.size()
                         ? clusters_before(set, TriangleRun::unpacked(order.runs[first_cutout]).first)
                         : set.clusters.size();
  report_progress(execution, "surfaces", 1);
  return set;
}

}  // namespace frontmost
