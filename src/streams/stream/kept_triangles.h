// SPDX-License-Identifier: Apache-2.0
// Copies of the triangles of a stream that are seen so far, and the scene that is made of them.
//
// A triangle is kept when it is seen after its piece was merged, and may be hidden by a later piece; so what is kept is
// thinned out from time to time, and at the end. Each has three vertices of its own: the piece that it came from is
// gone, with the numbers that its vertices had there.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/streams.h"
#include "stream/piece_loop.h"

namespace frontmost::streaming {

/// Triangles of one piece, each with corners of its own.
struct Kept {
  PiecePlace place;
  std::vector<std::uint32_t> triangles;  ///< numbers within the piece, ascending
  Mesh mesh;
};

/// Appends a triangle with all its attributes, corner by corner.
void append_triangle(const Mesh& from, std::uint32_t triangle, Mesh& to);

/// Leaves those for which is_wanted(number in the stream) is true.
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

/// By the number of the piece.
using KeptPieces = std::map<std::size_t, Kept>;

}  // namespace frontmost::streaming

namespace frontmost {

struct Excerpt::Parts {
  Parts(Scene kept, const Execution& execution) : scene(std::move(kept)), surfaces(scene, execution) {}
  const Scene scene;
  const Surfaces surfaces;
};

namespace streaming {

/// Ascending.
[[nodiscard]] std::vector<PrimitiveId> ids_of(const KeptPieces& kept);
/// `frame` with the triangles that were kept, in the order of the stream.
[[nodiscard]] Scene scene_of(Scene frame, KeptPieces kept);

}  // namespace streaming

}  // namespace frontmost
