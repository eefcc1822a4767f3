// SPDX-License-Identifier: Apache-2.0
// Copies of the triangles of a stream that are seen so far.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "frontmost/scene.h"
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
