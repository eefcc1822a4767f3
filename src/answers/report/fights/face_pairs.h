// SPDX-License-Identifier: Apache-2.0
// Which faces overlap on the screen and come near each other in depth.
//
//    +----+----+----+     Faces are entered into the cells that their rectangles touch; within a cell they are sorted
//    by |  /\|    |    |     their left ends, and only those whose rectangles and ranges of keys overlap are looked at.
//    A | /__\ \  |    |     pair that shares several cells is met in one: that of the upper left corner of what their
//    +----+----+----+     rectangles have in common.
#pragma once

#include <string>
#include <vector>

#include "report/fights/screen_faces.h"

namespace frontmost {

/// Numbers of two faces, the first less.
struct FacePair {
  std::uint32_t first, second;

  /// Of both, which orders them.
  [[nodiscard]] std::uint64_t number() const { return std::uint64_t(first) << 32 | second; }
  friend bool operator<(const FacePair& a, const FacePair& b) { return a.number() < b.number(); }
};

/// All pairs of faces of different primitives that have an area in common and keys within reach of each other; in
/// order. \throws Error limit_exceeded as find_fighting_faces() does.
[[nodiscard]] std::vector<FacePair> find_face_pairs(const std::vector<ScreenFace>& faces, const View& view,
                                                    const Execution& execution);

/// The text of an error: too many of these things, and where most faces lie.
[[nodiscard]] std::string too_many_faces(const std::vector<ScreenFace>& faces, const View& view,
                                         const std::string& things);

}  // namespace frontmost
