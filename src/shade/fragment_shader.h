// SPDX-License-Identifier: Apache-2.0
// Fragments in, colours out: collects them into batches, sorts each by triangle, and hands the answers back in the
// order of arrival.
#pragma once

#include <functional>
#include <vector>

#include "shade/batch.h"
#include "shade/geometry/geometry.h"

namespace frontmost::shading {

/// Triangles that were set up for one tile, by id: an open-addressing table.
class TriangleCache {
 public:
  TriangleCache() : slots_(slot_count), setups_(capacity) {}

  void clear() {
    ++generation_;
    count_ = 0;
  }
  static constexpr int capacity = 512;
  [[nodiscard]] bool is_full() const { return count_ == capacity; }
  [[nodiscard]] const std::vector<TriangleSetup>& setups() const { return setups_; }
  [[nodiscard]] std::vector<TriangleSetup>& setups() { return setups_; }

  struct Found {
    std::uint16_t number;
    bool is_new;  ///< to be set up by the caller
  };
  /// Precondition: not full.
  Found find_or_add(PrimitiveId id);

 private:
  static constexpr std::uint32_t slot_count = 2048;
  struct Slot {
    std::uint32_t generation = 0;
    PrimitiveId id = no_primitive;
    std::uint16_t number = 0;
  };

  std::vector<Slot> slots_;
  std::vector<TriangleSetup> setups_;
  std::uint32_t generation_ = 1;
  int count_ = 0;
};

/// Reused by one thread, from picture to picture. About half a megabyte.
class FragmentShader {
 public:
  /// Colours a batch: reads coverage and geometry, fills batch.light and batch.material.alpha.
  using Colorist = std::function<void(const std::vector<TriangleSetup>&, FragmentBatch&)>;

  /// Starts anew, for triangles and colours that are borrowed. Precondition for all else.
  void begin(const TriangleSource& source, const Colorist& colorist) {
    source_ = &source;
    colorist_ = &colorist;
    arrived_.count = 0;
    clear();
  }
  /// A fragment that hand_out() is to be called for before another is added.
  [[nodiscard]] bool is_full() const { return arrived_.count == batch_capacity || cache_.is_full(); }
  /// `number` is the caller's own; `screen` the position that is shaded, within the pixel of the `samples` (a bit
  /// each). Precondition: not full.
  void add(PrimitiveId id, std::uint32_t number, const glm::vec2& screen, std::uint64_t samples, float weight);
  /// Shades what was added and calls receive(number, weight, light, alpha) for each, in the order of arrival.
  template <class Receive>
  void hand_out(const Receive& receive) {
    if (arrived_.count > 0) shade_arrived();
    for (int k = 0; k < arrived_.count; ++k) {
      const int i = place_[k];
      receive(arrived_.pixel[k], arrived_.weight[k], batch_.light.at(i), batch_.material.alpha[i]);
    }
    arrived_.count = 0;
    if (cache_.is_full()) cache_.clear();
  }
  /// Forgets triangles. Precondition: everything was handed out.
  void clear() {
    cache_.clear();
    new_triangles_.clear();
  }

 private:
  void sort_by_triangle();
  void shade_arrived();

  const TriangleSource* source_ = nullptr;
  const Colorist* colorist_ = nullptr;
  TriangleCache cache_;
  std::vector<NewTriangle> new_triangles_;  ///< of the batch, not set up yet
  Coverage arrived_;                        ///< in the order of arrival; `pixel` is the caller's number
  std::uint16_t place_[batch_capacity];     ///< of each that arrived, in the batch
  FragmentBatch batch_;                     ///< by triangles
};

}  // namespace frontmost::shading
