// SPDX-License-Identifier: Apache-2.0
// Collects fragments into batches, sets up the triangles that a batch is the first to need, and returns the colours in
// the order in which the fragments were added.
#pragma once

#include <algorithm>
#include <bit>
#include <functional>
#include <vector>

#include "shade/batch.h"
#include "shade/geometry/geometry.h"

namespace frontmost::shading {

/// The triangles that were set up for one tile. An open-addressing table finds them by id.
class TriangleCache {
 public:
  TriangleCache() : slots_(slot_count), setups_(capacity + strip) {}

  void clear() {
    count_ = 0;
    if (++generation_ != 0) return;
    std::fill(slots_.begin(), slots_.end(), Slot{});  // after the counter wraps around, old slots would look new
    generation_ = 1;
  }
  static constexpr int capacity = 512, strip = 16;
  /// A cache that is full still takes the triangles of the strip of pixels that has filled it.
  [[nodiscard]] bool is_full() const { return count_ >= capacity; }
  [[nodiscard]] std::vector<TriangleSetup>& setups() { return setups_; }

  struct Found {
    std::uint16_t number;
    bool is_new;  ///< the caller has to set up this triangle
  };
  /// Returns the number of a triangle, which is added if it is absent. Precondition: the cache is not full, or became
  /// so within the current strip.
  Found find_or_add(PrimitiveId id) {
    std::uint32_t slot = id * 0x9E3779B1u >> 21;  // 11 bits: slot_count
    while (slots_[slot].generation == generation_) {
      if (slots_[slot].id == id) return {slots_[slot].number, false};
      slot = (slot + 1) % slot_count;
    }
    slots_[slot] = {id, generation_, std::uint16_t(count_++)};
    return {slots_[slot].number, true};
  }

 private:
  static constexpr std::uint32_t slot_count = 2048;
  struct Slot {
    PrimitiveId id = no_primitive;
    std::uint16_t generation = 0, number = 0;
  };

  std::vector<Slot> slots_;
  std::vector<TriangleSetup> setups_;
  std::uint16_t generation_ = 1;
  int count_ = 0;
};

/// Shades fragments in one thread. The object, of about half a megabyte, is used again for every picture.
class FragmentShader {
 public:
  /// Colours a batch: reads coverage and geometry, and fills batch.light and batch.material.alpha.
  using Colorist = std::function<void(const std::vector<TriangleSetup>&, FragmentBatch&)>;

  /// Starts a picture, and borrows its arguments. Must come before all other functions. If `steps` is not null, it must
  /// hold the steps of all fragments added before the next hand_out(), in the order of these fragments.
  void begin(const TriangleSource& source, const Colorist& colorist, Isa isa, const PixelSteps* steps = nullptr) {
    isa_ = isa;
    source_ = &source;
    colorist_ = &colorist;
    batch_.coverage.count = 0;
    batch_.coverage.steps = steps;
    clear();
  }
  /// Returns how many more fragments can be added before hand_out().
  [[nodiscard]] int room() const { return cache_.is_full() ? 0 : batch_capacity - batch_.coverage.count; }
  [[nodiscard]] bool is_full() const { return room() == 0; }
  /// Returns how many fragments were added since the last hand_out().
  [[nodiscard]] int count() const { return batch_.coverage.count; }
  /// Adds a fragment, shaded at the position `screen`. The caller chooses `number`; `samples` has one bit for each
  /// covered sample of the pixel. Precondition: not full.
  void add(PrimitiveId id, std::uint32_t number, const glm::vec2& screen, std::uint64_t samples, float weight) {
    add_row(id, 1, {number, screen, samples, weight});
  }
  /// The values that the pixels of a row share, with the number and position of the first pixel.
  struct RowStart {
    std::uint32_t number;
    glm::vec2 screen;
    std::uint64_t samples;
    float weight;
    int step = 1;  ///< distance from one pixel to the next
  };
  /// Adds `count` pixels of a row. Their numbers are `step` apart, like the pixels. Precondition: room() >= count.
  void add_row(PrimitiveId id, int count, const RowStart& start) {
    const TriangleCache::Found found = cache_.find_or_add(id);
    if (found.is_new) new_triangles_.push_back({id, found.number, start.screen});
    Coverage& out = batch_.coverage;
    // Four pixels are written at a time, because most rows are that short. The next row overwrites any excess.
    constexpr int at_once = 4;
    for (int k = 0; k < count; k += at_once)
      for (int lane = 0; lane < at_once; ++lane) {
        const int i = out.count + k + lane;
        out.pixel[i] = start.number + std::uint32_t(start.step * (k + lane));
        out.triangle[i] = found.number;
        out.samples[i] = start.samples;
        out.weight[i] = start.weight;
        out.screen.x[i] = start.screen.x + float(start.step * (k + lane));
        out.screen.y[i] = start.screen.y;
      }
    out.count += count;
  }
  /// The greatest number of pixels of a strip.
  static constexpr int strip = TriangleCache::strip;
  [[nodiscard]] bool has_room_for_strip() const { return room() >= strip; }
  /// Adds the pixels of a strip, a part of a row, that show anything. `ids` are their primitives. Precondition:
  /// has_room_for_strip().
  void add_strip(const PrimitiveId* ids, int count, const RowStart& start) {
    Coverage& out = batch_.coverage;
    std::uint32_t begins = 1, shown = 0;  // bits of the pixels that differ from the one before, and of those not empty
    for (int k = 1; k < count; ++k) begins |= std::uint32_t(ids[k] != ids[k - 1]) << k;
    for (int k = 0; k < count; ++k) shown |= std::uint32_t(ids[k] != no_primitive) << k;
    // Every run of pixels writes its triangle's number to the end of the strip and beyond, and the next run overwrites
    // it: fixed lengths need no branches.
    for (std::uint32_t left = begins & shown; left != 0; left &= left - 1) {
      const int k = std::countr_zero(left);
      const TriangleCache::Found found = cache_.find_or_add(ids[k]);
      if (found.is_new) new_triangles_.push_back({ids[k], found.number, {start.screen.x + float(k), start.screen.y}});
      std::fill_n(out.triangle + out.count + k, strip, found.number);
    }
    for (int k = 0; k < strip; ++k) {
      const int i = out.count + k;
      out.pixel[i] = start.number + std::uint32_t(k);
      out.samples[i] = start.samples;
      out.weight[i] = start.weight;
      out.screen.x[i] = start.screen.x + float(k);
      out.screen.y[i] = start.screen.y;
    }
    if (shown + 1 == 1u << count) return void(out.count += count);
    int i = out.count;
    for (; shown != 0; shown &= shown - 1, ++i) {
      const int from = out.count + std::countr_zero(shown);
      out.pixel[i] = out.pixel[from];
      out.triangle[i] = out.triangle[from];
      out.screen.x[i] = out.screen.x[from];
    }
    out.count = i;
  }
  /// The result for one fragment.
  struct Shaded {
    std::uint32_t number;
    float weight;
    glm::vec3 light;   ///< not premultiplied
    float alpha;       ///< mean over the channels
    glm::vec3 alphas;  ///< of each colour channel
  };
  /// Shades the added fragments and calls receive(shaded) for each, in the order in which they were added.
  template <class Receive>
  void hand_out(const Receive& receive) {
    Coverage& coverage = batch_.coverage;
    if (coverage.count > 0) shade_arrived();
    const bool has_filters = batch_.layers.has_transmission;
    for (int i = 0; i < coverage.count; ++i) {
      const float alpha = batch_.material.alpha[i];
      const glm::vec3 alphas = has_filters ? batch_.alphas.at(i) : glm::vec3(alpha);
      receive(Shaded{coverage.pixel[i], coverage.weight[i], batch_.light.at(i), alpha, alphas});
    }
    coverage.count = 0;
    if (cache_.is_full()) cache_.clear();
  }
  /// Clears the table of triangles. Precondition: no fragments are waiting.
  void clear() {
    cache_.clear();
    new_triangles_.clear();
  }

 private:
  void shade_arrived() {
    source_->set_up(new_triangles_, cache_.setups());
    new_triangles_.clear();
    interpolate_geometry(source_->rays(), cache_.setups(), batch_, isa_);
    (*colorist_)(cache_.setups(), batch_);
  }

  const TriangleSource* source_ = nullptr;
  const Colorist* colorist_ = nullptr;
  Isa isa_ = Isa::best;
  TriangleCache cache_;
  std::vector<NewTriangle> new_triangles_;  ///< triangles of the batch that are still to be set up
  FragmentBatch batch_;                     ///< in the order of add(); coverage.pixel is the caller's number
};

}  // namespace frontmost::shading
