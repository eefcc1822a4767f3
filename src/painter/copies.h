// SPDX-License-Identifier: Apache-2.0
// Triangles that lie in one another's place: exporters write faces twice, and models are placed twice.
#pragma once

#include <vector>

#include "frontmost/painter.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// Of triangles with the same corners one alone is put into order and cut, that of the lowest id: it is on top of the
/// others, which lie wherever it lies.
class Copies {
 public:
  /// Takes copies out of `members`, which are in the order of their ids. O(members).
  Copies(const Pieces& pieces, std::vector<std::uint32_t>& members);

  /// Puts them back, directly below the pieces of the one that stayed, but for those that it hides, if it is an
  /// occluder. \throws Error limit_exceeded for more than `most` pieces then.
  void put_back(Pieces& pieces, std::vector<std::uint32_t>& members, const Occluders& occluders,
                std::size_t most) const;

 private:
  struct Copy {
    PrimitiveId of;
    std::uint32_t piece;
  };
  struct Range {
    std::vector<Copy>::const_iterator begin, end;
    [[nodiscard]] std::size_t count() const { return std::size_t(end - begin); }
  };
  [[nodiscard]] Range of(PrimitiveId id, const Occluders& occluders) const;

  std::vector<Copy> copies_;  ///< by what they are copies of, each list from its lowest to its highest id
};

}  // namespace frontmost::painter_detail
