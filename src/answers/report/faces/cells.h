// SPDX-License-Identifier: Apache-2.0
// Visible faces cell by cell of the picture: at once in cells where no relevant surface ends, else in smaller cells.
//
//    eye                      In a cell, a group of faces lies nearer than all others, by the ranges of their keys.
//     |    ____               If no surface ends at their sides within the cell, the number of them over a place is
//     |   /    \__  group     the same everywhere, so one place tells it. (A side is plain if one face continues
//     |  ~~~~~~~~~~           another there.) If the number is 1, every face of the group is seen as far as it lies
//     |   . . . .   others    in the cell. If it is 1 or more, nothing behind the group is seen.
//     v
#pragma once

#include "report/faces/pieces.h"

namespace frontmost::faces_detail {

struct SeenParts {
  Buffer<std::uint8_t> is_whole;             ///< by face: all of it is seen; the face then has no parts
  std::vector<std::vector<SeenPart>> parts;  ///< parts of the other faces; a face may have several
};

/// Finds all visible parts in the view. The result is the same for any number of threads. O(faces + cells in which
/// surfaces end). \throws Error limit_exceeded for more than FacesOfView::most_steps.
[[nodiscard]] SeenParts seen_parts(const FacesOfView& faces, const View& view, const Execution& execution);

}  // namespace frontmost::faces_detail
