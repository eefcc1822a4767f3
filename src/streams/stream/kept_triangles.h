// SPDX-License-Identifier: Apache-2.0
// Copies of the triangles of a stream that are visible so far, and the scene that is made of them.
//
// A triangle is kept if it is visible after its piece was merged. A later piece may hide it, so hidden triangles are
// removed from time to time and at the end. Each triangle has three vertices of its own, because the vertex indices of
// its piece are gone together with the piece. Triangles keep the stream's order, so at equal depths the same triangle
// has the lower id: everything computed from the excerpt is the same as from the whole model.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "frontmost/scene.h"
#include "frontmost/streams.h"
#include "stream/piece_loop.h"

namespace frontmost {

struct Excerpt::Parts {
  Parts(Scene kept, const Execution& execution) : scene(std::move(kept)), surfaces(scene, execution) {}
  const Scene scene;
  const Surfaces surfaces;
};

namespace streaming {

/// Kept triangles of one piece, each with three vertices of its own.
struct Kept {
  PiecePlace place;
  std::vector<std::uint32_t> triangles;  ///< numbers within the piece, ascending
  Mesh mesh;
};

/// Kept triangles by the number of their piece.
using KeptPieces = std::map<std::size_t, Kept>;

/// Appends a triangle with all its attributes, corner by corner.
void append_triangle(const Mesh& from, std::uint32_t triangle, Mesh& to);

/// Removes triangles for which is_wanted(number in the stream) is false.
template <class IsWanted>
void thin_out(Kept& kept, const IsWanted& is_wanted) {
  Kept rest{kept.place, {}, {}};
  for (std::uint32_t i = 0; i < kept.triangles.size(); ++i) {
    if (!is_wanted(kept.place.first + kept.triangles[i])) continue;
    rest.triangles.push_back(kept.triangles[i]);
    append_triangle(kept.mesh, i, rest.mesh);
  }
  kept = std::move(rest);
}

/// Numbers of the kept triangles in the stream, ascending.
[[nodiscard]] std::vector<PrimitiveId> ids_of(const KeptPieces& kept);
/// \returns `frame` with the kept triangles, in the order of the stream.
[[nodiscard]] Scene scene_of(Scene frame, KeptPieces kept);

/// Maps numbers of triangles in a stream to their indices among the kept triangles.
///
///   ids kept     3   17   20   21   |  130  131  |  ...        ascending; few of many
///   buckets      by upper bits: the first index of each, so that a look-up is one step and a short search
class IdMap {
 public:
  /// `ids` ascend, and are borrowed.
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
      for (PrimitiveId& id : ids.subspan(begin, end - begin)) {
        if (id != last) place = place_of(id);
        last = id;
        id = place;
      }
    });
  }

 private:
  const std::vector<PrimitiveId>& ids_;
  int shift_ = 0;
  std::vector<std::uint32_t> begin_;  ///< first index of each bucket; then the number of ids
};

}  // namespace streaming
}  // namespace frontmost
