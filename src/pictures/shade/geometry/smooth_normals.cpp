// SPDX-License-Identifier: Apache-2.0
// Corners are sorted into buckets by a hash of their positions. A bucket fits into the first cache levels, and one
// thread works on it. Corners keep the order of their triangles, so sums do not depend on the number of threads.
// Positions at which no triangle is requested are dropped first. On a closed mesh this saves about half of the work.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "shade/geometry/geometry.h"

namespace frontmost::shading {
namespace {

constexpr std::size_t kTrianglesAtOnce = 1u << 13;
constexpr std::size_t kCornersPerBucket = 4096;
/// If more corners have one position, every facet keeps its own normal there, because all pairs would be compared.
constexpr std::size_t kMostCorners = 256;
/// Corners have 32-bit numbers, so on larger meshes every facet keeps its own normal.
constexpr std::size_t kMostTriangles = std::size_t(1) << 30;

using PositionBits = std::array<std::uint32_t, 3>;

PositionBits bits_of(const glm::vec3& position) {
  const glm::vec3 p = position + 0.0f;  // -0 is 0
  PositionBits bits;
  std::memcpy(bits.data(), &p, sizeof bits);
  return bits;
}

std::uint32_t hash_of(const PositionBits& bits) {
  std::uint32_t h = (bits[0] * 0x9E3779B1u) ^ (bits[1] * 0x85EBCA77u) ^ (bits[2] * 0xC2B2AE3Du);
  h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
  h = (h ^ (h >> 13)) * 0x297A2D39u;
  return h ^ (h >> 16);
}

/// Returns the angle from 0 to pi with this ratio of sine and cosine, to 0.005, which is precise enough for a weight.
double angle_of(double sine, double cosine) {
  const double c = std::abs(cosine);
  const bool steep = sine > c;
  const double ratio = steep ? c / sine : (c > 0 ? sine / c : 0.0);
  const double arc = ratio * (0.9724 - 0.1919 * ratio * ratio);
  constexpr double quarter = 1.5707963267948966;
  const double angle = steep ? quarter - arc : arc;
  return cosine < 0 ? 2 * quarter - angle : angle;
}

struct Facet {
  glm::dvec3 normal{0};  ///< unit, or zero
  double weight = 0;
};

Facet facet_at(const Mesh& mesh, std::uint32_t corner) {
  const glm::uvec3& t = mesh.triangles[corner / 3];
  const int k = int(corner % 3);
  const glm::dvec3 p(mesh.positions[t[k]]);
  const glm::dvec3 to_next = glm::dvec3(mesh.positions[t[(k + 1) % 3]]) - p;
  const glm::dvec3 to_last = glm::dvec3(mesh.positions[t[(k + 2) % 3]]) - p;
  const glm::dvec3 cross = glm::cross(to_next, to_last);
  const double area = std::sqrt(glm::dot(cross, cross));
  if (!(area > 0 && area < 1e300)) return {};
  return {cross / area, area * angle_of(area, glm::dot(to_next, to_last))};
}

class Smoother {
 public:
  Smoother(const Mesh& mesh, const std::function<bool(std::uint32_t)>& is_wanted, const Execution& execution)
      : mesh_(mesh), execution_(execution), wanted_(mesh.triangles.size()), normals_(mesh.triangles.size()) {
    std::atomic<std::size_t> count{0};
    parallel_for(execution, mesh.triangles.size(), kTrianglesAtOnce, [&](std::size_t begin, std::size_t end) {
      std::size_t found = 0;
      for (std::size_t t = begin; t < end; ++t)
        if (is_wanted(std::uint32_t(t))) {
          wanted_.add(t);
          ++found;
        }
      count += found;
    });
    wanted_count_ = count;
  }

  PackedCornerNormals run() && {
    if (mesh_.triangles.size() > kMostTriangles) {
      for_wanted([&](std::size_t t) { keep_facet(t); });
    } else if (wanted_count_ > 0) {
      mark_touched_positions();
      sort_into_buckets();
      parallel_for(execution_, bucket_count(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) smooth_bucket(b);
      });
    }
    return std::move(normals_);
  }

 private:
  [[nodiscard]] const glm::vec3& position(std::uint32_t corner) const {
    return mesh_.positions[mesh_.triangles[corner / 3][int(corner % 3)]];
  }
  [[nodiscard]] std::size_t bucket_count() const { return std::size_t(1) << bucket_bits_; }
  [[nodiscard]] std::size_t bucket_of(std::uint32_t hash) const { return std::size_t(hash) >> (32 - bucket_bits_); }

  template <class Visit>
  void for_wanted(const Visit& visit) const {
    parallel_for(execution_, mesh_.triangles.size(), kTrianglesAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        if (wanted_.contains(t)) visit(t);
    });
  }

  void keep_facet(std::size_t t) { normals_[t].fill(pack(glm::vec3(facet_at(mesh_, std::uint32_t(3 * t)).normal))); }

  void mark_touched_positions() {
    int bits = 10;
    while (bits < 30 && (std::size_t(1) << bits) < 16 * wanted_count_) ++bits;
    touched_mask_ = (std::uint32_t(1) << bits) - 1;
    touched_ = BitSet(std::size_t(1) << bits);
    for_wanted([&](std::size_t t) {
      for (int k = 0; k < 3; ++k)
        touched_.add(hash_of(bits_of(mesh_.positions[mesh_.triangles[t][k]])) & touched_mask_);
    });
  }

  struct Touched {
    std::uint32_t corner, hash;
  };

  [[nodiscard]] std::vector<Touched> find_touched(std::size_t begin, std::size_t end) const {
    std::vector<Touched> found;
    for (std::size_t t = begin; t < end; ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t hash = hash_of(bits_of(mesh_.positions[mesh_.triangles[t][k]]));
        if (touched_.contains(hash & touched_mask_)) found.push_back({std::uint32_t(3 * t) + std::uint32_t(k), hash});
      }
    return found;
  }

  void sort_into_buckets() {
    while (bucket_bits_ < 9 && (kCornersPerBucket << bucket_bits_) < 6 * wanted_count_) ++bucket_bits_;
    const std::size_t count = (mesh_.triangles.size() + kTrianglesAtOnce - 1) / kTrianglesAtOnce;
    std::vector<std::vector<Touched>> parts(count);
    // Counts the corners of each part in each bucket, then finds their places, then writes the corners.
    std::vector<std::uint32_t> place(count * bucket_count());
    parallel_for(execution_, mesh_.triangles.size(), kTrianglesAtOnce, [&](std::size_t begin, std::size_t end) {
      const std::size_t part = begin / kTrianglesAtOnce;
      parts[part] = find_touched(begin, end);
      for (const Touched& touched : parts[part]) ++place[part * bucket_count() + bucket_of(touched.hash)];
    });
    bucket_begin_.assign(bucket_count() + 1, 0);
    std::uint32_t total = 0;
    for (std::size_t b = 0; b < bucket_count(); ++b) {
      bucket_begin_[b] = total;
      for (std::size_t part = 0; part < count; ++part) total += std::exchange(place[part * bucket_count() + b], total);
    }
    bucket_begin_[bucket_count()] = total;
    corners_ = Buffer<std::uint32_t>(total);
    parallel_for(execution_, count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part)
        for (const Touched& touched : parts[part])
          corners_[place[part * bucket_count() + bucket_of(touched.hash)]++] = touched.corner;
    });
  }

  /// Prefetches the data of corners further on in a bucket, since they are spread over the mesh.
  void prefetch(const std::uint32_t* corners, std::uint32_t i, std::uint32_t count) const {
    constexpr std::uint32_t kTrianglesAhead = 32, kPositionsAhead = 16;
    if (i + kTrianglesAhead < count) prefetch_line(&mesh_.triangles[corners[i + kTrianglesAhead] / 3]);
    if (i + kPositionsAhead >= count) return;
    const glm::uvec3& triangle = mesh_.triangles[corners[i + kPositionsAhead] / 3];
    for (int k = 0; k < 3; ++k) prefetch_line(&mesh_.positions[triangle[k]]);
  }

  void smooth_bucket(std::size_t bucket);
  void smooth_group(const std::vector<std::uint32_t>& group, const std::uint32_t* corners, const Facet* facets);

  const Mesh& mesh_;
  const Execution& execution_;
  BitSet wanted_;
  std::size_t wanted_count_ = 0;
  PackedCornerNormals normals_;
  BitSet touched_;  ///< hashes of positions of requested triangles
  std::uint32_t touched_mask_ = 0;
  int bucket_bits_ = 1;
  std::vector<std::uint32_t> bucket_begin_;
  Buffer<std::uint32_t> corners_;  ///< corner numbers by bucket, ascending in each bucket
};

/// The corners of one bucket, in a chain for each position. An open-addressing table finds the chains.
class Chains {
 public:
  static constexpr std::uint32_t none = 0xFFFFFFFFu;

  explicit Chains(std::size_t count) : next_(count, none), last_(count) {
    std::size_t size = 16;
    while (size < 2 * count) size *= 2;
    slots_.assign(size, none);
  }

  /// Appends entry i to the chain whose first entry satisfies is_same(first), or starts a chain.
  template <class IsSame>
  void add(std::uint32_t i, std::uint32_t hash, const IsSame& is_same) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash & mask;
    while (slots_[slot] != none && !is_same(slots_[slot])) slot = (slot + 1) & mask;
    if (slots_[slot] == none) {
      slots_[slot] = i;
      firsts_.push_back(i);
    } else {
      next_[last_[slots_[slot]]] = i;
    }
    last_[slots_[slot]] = i;
  }
  [[nodiscard]] const std::vector<std::uint32_t>& firsts() const { return firsts_; }
  [[nodiscard]] std::uint32_t next(std::uint32_t i) const { return next_[i]; }

 private:
  std::vector<std::uint32_t> slots_, firsts_, next_, last_;
};

void Smoother::smooth_bucket(std::size_t bucket) {
  const std::uint32_t* corners = corners_.data() + bucket_begin_[bucket];
  const std::uint32_t count = bucket_begin_[bucket + 1] - bucket_begin_[bucket];
  std::vector<PositionBits> positions(count);
  // Facets are made in this order, and not by chain, while the prefetched positions are still in the cache.
  std::vector<Facet> facets(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    prefetch(corners, i, count);
    positions[i] = bits_of(position(corners[i]));
    facets[i] = facet_at(mesh_, corners[i]);
  }
  Chains chains(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const PositionBits& p = positions[i];
    chains.add(i, hash_of(p), [&](std::uint32_t first) { return positions[first] == p; });
  }
  std::vector<std::uint32_t> group;
  for (const std::uint32_t first : chains.firsts()) {
    group.clear();
    for (std::uint32_t i = first; i != Chains::none; i = chains.next(i)) group.push_back(i);
    smooth_group(group, corners, facets.data());
  }
}

/// `group` are the places of corners with one position among those of the bucket.
void Smoother::smooth_group(const std::vector<std::uint32_t>& group, const std::uint32_t* corners,
                            const Facet* facets) {
  for (const std::uint32_t i : group) {
    if (!wanted_.contains(corners[i] / 3)) continue;
    const Facet& own = facets[i];
    glm::dvec3 sum = own.normal * own.weight;
    if (group.size() <= kMostCorners)
      for (const std::uint32_t j : group)
        if (j != i && glm::dot(own.normal, facets[j].normal) >= crease_cosine)
          sum += facets[j].normal * facets[j].weight;
    const double length = std::sqrt(glm::dot(sum, sum));
    normals_[corners[i] / 3][corners[i] % 3] = pack(glm::vec3(length > 0 ? sum / length : own.normal));
  }
}

float sign_of(float value) { return value < 0 ? -1.0f : 1.0f; }

std::int16_t to_int16(float value) { return std::int16_t(value * 32767.0f + (value < 0 ? -0.5f : 0.5f)); }

}  // namespace

PackedNormal pack(const glm::vec3& direction) {
  const float size = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
  if (!(size > 0)) return {};
  glm::vec2 p(direction.x / size, direction.y / size);
  if (direction.z < 0) p = {(1.0f - std::abs(p.y)) * sign_of(p.x), (1.0f - std::abs(p.x)) * sign_of(p.y)};
  return {to_int16(p.x), to_int16(p.y)};
}

glm::vec3 unpack(PackedNormal packed) {
  const glm::vec2 p(float(packed.x) / 32767.0f, float(packed.y) / 32767.0f);
  const float z = 1.0f - std::abs(p.x) - std::abs(p.y);
  if (z >= 0) return {p.x, p.y, z};
  return {(1.0f - std::abs(p.y)) * sign_of(p.x), (1.0f - std::abs(p.x)) * sign_of(p.y), z};
}

PackedCornerNormals smooth_normals(const Mesh& mesh, const std::function<bool(std::uint32_t)>& is_wanted,
                                   const Execution& execution) {
  return Smoother(mesh, is_wanted, execution).run();
}

}  // namespace frontmost::shading
