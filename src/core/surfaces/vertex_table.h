// SPDX-License-Identifier: Apache-2.0
// Finds the number of a triangle's vertex in its cluster.
//
//   key --hash--> guesses_[4096] --> a number --> keys_ of that number: the same bits?
//                                                 yes: that is the vertex; no: a new one, which becomes the guess
#pragma once

#include <algorithm>
#include <array>
#include <cstring>

#include "surfaces/cluster_set.h"

namespace frontmost {

constexpr std::size_t padded_to_lanes(std::size_t count) {
  return (count + Cluster::lanes - 1) / Cluster::lanes * Cluster::lanes;
}

/// The identity of a vertex. Vertices of two instances remain two vertices if they coincide, and so do vertices of one
/// instance that its transform flattens to one place, because each vertex must follow its instance when it moves.
struct VertexKey {
  glm::vec3 position;  ///< in the space of the mesh
  std::uint32_t instance = 0;
};

/// A table of the vertices of one cluster, used for one cluster after the other. Vertices are identified by the bits of
/// their position, not by number, which suits both indexed meshes and soups. In a soup, such as an STL file, every
/// triangle has vertex numbers of its own, and welding doubles the triangles that a cluster holds.
///
/// The hash of a vertex leads to a guess, the number of a vertex that is then compared. Guesses are never cleared, and
/// a guess may be overwritten by another vertex with the same hash. The former vertex is then stored twice if it
/// returns, which takes room and changes no picture. In return the table neither searches nor branches: a branch on
/// whether a vertex is new is unpredictable, and would cost more than all the rest.
class VertexTable {
 public:
  static constexpr std::uint8_t none = 0xFF;

  void clear() { count_ = 0; }
  [[nodiscard]] std::size_t size() const { return count_; }

  /// The number of a vertex, or `none` if intern() would add the vertex.
  [[nodiscard]] std::uint8_t find(const VertexKey& key) const {
    const Bits bits = bits_of(key);
    const std::uint8_t guess = guesses_[hash(bits)];
    return is_at(guess, bits) ? guess : none;
  }
  /// The number of a vertex; adds the vertex if it is not found. Precondition: there is room for one more.
  std::uint8_t intern(const VertexKey& key, const glm::vec3& p) {
    const Bits bits = bits_of(key);
    std::uint8_t& guess = guesses_[hash(bits)];
    const bool found = is_at(guess, bits);
    const std::uint32_t number = found ? guess : count_;
    keys_[number] = bits;
    x_[number] = p.x, y_[number] = p.y, z_[number] = p.z;
    guess = static_cast<std::uint8_t>(number);
    count_ += !found;
    return static_cast<std::uint8_t>(number);
  }
  [[nodiscard]] glm::vec3 operator[](std::size_t i) const { return {x_[i], y_[i], z_[i]}; }

  /// Repeats the last vertex to fill whole vectors. \returns the new size, 0 for an empty table.
  std::size_t pad() {
    if (count_ == 0) return 0;
    const std::size_t end = padded_to_lanes(count_);
    for (auto* axis : {&x_, &y_, &z_}) std::fill(axis->begin() + count_, axis->begin() + end, (*axis)[count_ - 1]);
    return end;
  }
  /// Bounds of all vertices. Precondition: pad() was called after the last vertex was added.
  [[nodiscard]] Box bounds() const {
    Box box;
    for (int k = 0; k < 3; ++k) {
      const auto& axis = k == 0 ? x_ : k == 1 ? y_ : z_;
      // Lanes are independent, so that the compiler can use vectors and no comparison waits for the one before.
      std::array<float, Cluster::lanes> low, high;
      low.fill(std::numeric_limits<float>::infinity());
      high.fill(-std::numeric_limits<float>::infinity());
      for (std::size_t i = 0; i < padded_to_lanes(count_); i += Cluster::lanes)
        for (std::size_t lane = 0; lane < Cluster::lanes; ++lane) {
          const float v = axis[i + lane];
          low[lane] = v < low[lane] ? v : low[lane];
          high[lane] = v > high[lane] ? v : high[lane];
        }
      box.low[k] = *std::min_element(low.begin(), low.end());
      box.high[k] = *std::max_element(high.begin(), high.end());
    }
    return box;
  }
  [[nodiscard]] const float* x() const { return x_.data(); }
  [[nodiscard]] const float* y() const { return y_.data(); }
  [[nodiscard]] const float* z() const { return z_.data(); }

 private:
  using Bits = std::array<std::uint32_t, 4>;
  static constexpr int kHashBits = 12;  // with fewer, guesses are lost more often

  static Bits bits_of(const VertexKey& key) {
    Bits bits;
    static_assert(sizeof bits == sizeof key);
    std::memcpy(bits.data(), &key, sizeof bits);
    return bits;
  }
  /// Round numbers differ only in their high bits; multiplication moves these and all other bits to the top.
  static std::uint32_t hash(const Bits& b) {
    return (b[0] * 0x9E3779B1u + b[1] * 0x85EBCA77u + b[2] * 0xC2B2AE3Du + b[3] * 0x27D4EB2Fu) >> (32 - kHashBits);
  }
  [[nodiscard]] bool is_at(std::uint8_t number, const Bits& bits) const {
    const Bits& other = keys_[number];
    const std::uint32_t differing =
        (bits[0] ^ other[0]) | (bits[1] ^ other[1]) | (bits[2] ^ other[2]) | (bits[3] ^ other[3]);
    return static_cast<bool>(int(number < count_) & int(differing == 0));
  }

  std::array<std::uint8_t, std::size_t(1) << kHashBits> guesses_{};
  std::array<Bits, Cluster::max_vertices> keys_{};  // a guess may name a vertex that does not exist
  std::array<float, Cluster::max_vertices> x_, y_, z_;
  std::uint32_t count_ = 0;
};

}  // namespace frontmost
