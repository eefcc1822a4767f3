// SPDX-License-Identifier: Apache-2.0
// Pairs of faces that overlap on the screen and come close to each other in depth.
//
//    +----+----+----+     Faces are entered into the cells that their rectangles touch. Within a cell they are sorted
//    |  /\|    |    |     by their left ends, and only faces whose rectangles and ranges of keys overlap are compared.
//    | /__\ \  |    |     A pair that shares several cells is found in one: that of the upper left corner of the
//    +----+----+----+     common part of their rectangles.
#pragma once

#include <string>
#include <vector>

#include "report/fights/screen_faces.h"

namespace frontmost {

/// Numbers of two faces, the lower one first.
struct FacePair {
  std::uint32_t first, second;

  /// Both numbers as one, by which pairs are ordered.
  [[nodiscard]] std::uint64_t number() const { return std::uint64_t(first) << 32 | second; }
  friend bool operator<(const FacePair& a, const FacePair& b) { return a.number() < b.number(); }
};

/// Finds all pairs of faces of different primitives that have an area in common and keys within reach of each other; in
/// order. \throws Error limit_exceeded as find_fighting_faces() does.
[[nodiscard]] std::vector<FacePair> find_face_pairs(const std::vector<ScreenFace>& faces, const View& view,
                                                    const Execution& execution);

/// The text of an error: there are too many of these things, and where most faces lie.
[[nodiscard]] std::string too_many_faces(const std::vector<ScreenFace>& faces, const View& view,
                                         const std::string& things);

}  // namespace frontmost
