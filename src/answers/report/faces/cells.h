// SPDX-License-Identifier: Apache-2.0
// What is seen cell by cell of the picture: at once where nothing ends that matters, else in smaller cells.
//
//    eye                      In a cell a group of faces lies nearer than all others, by the ranges of their keys.
//     |    ____               Where no surface ends at a side of theirs within the cell, the number of them over a
//     place |   /    \__  group     is the same everywhere (a side is plain where one face takes over from another); so
//     one |  ~~~~~~~~~~           place tells it. Is it 1, then each of them is seen as far as it lies in the cell; is
//     it |   . . . .   others    at least 1, then nothing else is.
//     v
#pragma once

#include "report/faces/pieces.h"

namespace frontmost::faces_detail {

struct SeenParts {
  Buffer<std::uint8_t> is_whole;             ///< by face: all of it is seen, and it has no parts
  std::vector<std::vector<SeenPart>> parts;  ///< of the others; a face may have several
};

/// All that is seen in the view. The same for any number of threads. O(faces + cells in which surfaces end).
/// \throws Error limit_exceeded where that takes more than FacesOfView::most_steps.
[[nodiscard]] SeenParts seen_parts(const FacesOfView& faces, const View& view, const Execution& execution);

}  // namespace frontmost::faces_detail
