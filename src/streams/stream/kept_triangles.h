// SPDX-License-Identifier: Apache-2.0
// Copies of the triangles of a stream that are visible so far, and the scene that is made of them.
//
// A triangle is kept if it is visible after its piece was merged. A later piece may hide it, so hidden triangles are
// removed from time to time and at the end. Each triangle has three vertices of its own, because the vertex indices of
// its piece are gone together with the piece.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/streams.h"
#include "stream/piece_loop.h"

namespace frontmost::streaming {

/// Kept triangles of one piece, each with three vertices of its own.
struct Kept {
  PiecePlace place;
  std::vector<std::uint32_t> triangles;  ///< numbers within the piece, ascending
  Mesh mesh;
};

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

/// Kept triangles by the number of their piece.
using KeptPieces = std::map<std::size_t, Kept>;

}  // namespace frontmost::streaming

namespace frontmost {

struct Excerpt::Parts {
  Parts(Scene kept, const Execution& execution) : scene(std::move(kept)), surfaces(scene, execution) {}
  const Scene scene;
  const Surfaces surfaces;
};

namespace streaming {

/// Numbers of the kept triangles in the stream, ascending.
[[nodiscard]] std::vector<PrimitiveId> ids_of(const KeptPieces& kept);
/// \returns `frame` with the kept triangles, in the order of the stream.
[[nodiscard]] Scene scene_of(Scene frame, KeptPieces kept);

}  // namespace streaming

}  // namespace frontmost
