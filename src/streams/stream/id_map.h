// SPDX-License-Identifier: Apache-2.0
// Maps numbers of triangles in a stream to their indices among the kept triangles.
//
//   ids kept     3   17   20   21   |  130  131  |  ...        ascending; few of many
//   buckets      by upper bits: the first index of each, so that a look-up is one step and a short search
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "frontmost/view.h"

namespace frontmost::streaming {

class IdMap {
 public:
  /// `ids` ascending; borrowed.
  explicit IdMap(const std::vector<PrimitiveId>& ids) : ids_(ids) {
    if (ids.empty()) return;
    while ((std::size_t(ids.back()) >> shift_) > ids.size()) ++shift_;
    begin_.resize((std::size_t(ids.back()) >> shift_) + 2);
    for (const PrimitiveId id : ids) ++begin_[(id >> shift_) + 1];
    for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
  }

  /// \returns no_primitive for an id that was not kept. O(1) if ids are spread evenly, O(log) at worst.
  [[nodiscard]] PrimitiveId place_of(PrimitiveId id) const {
    const std::size_t bucket = id >> shift_;
    if (bucket + 1 >= begin_.size()) return no_primitive;
    const auto begin = ids_.begin(), end = begin + begin_[bucket + 1];
    const auto found = std::lower_bound(begin + begin_[bucket], end, id);
    return found == end || *found != id ? no_primitive : PrimitiveId(found - begin);
  }

  /// Replaces ids by their indices.
  void apply(std::span<PrimitiveId> ids, const Execution& execution) const {
    constexpr std::size_t samples_at_once = 1u << 16;
    parallel_for(execution, ids.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
      PrimitiveId last = no_primitive, place = no_primitive;
      for (std::size_t i = begin; i < end; ++i) {
        PrimitiveId& id = ids[i];
        if (id == no_primitive) continue;
        if (id != last) {
          last = id;
          place = place_of(id);
        }
        id = place;
      }
    });
  }

 private:
  const std::vector<PrimitiveId>& ids_;
  int shift_ = 0;
  std::vector<std::uint32_t> begin_;  ///< first index of each bucket, and the end of the last
};

}  // namespace frontmost::streaming
