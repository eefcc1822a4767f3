// SPDX-License-Identifier: Apache-2.0
// Boxes around many pieces at a time, to pass them over together.
#pragma once

#include <span>

#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// A list of pieces, in boxes around 64, around 64 of those, and so on. A box lies along the plane of one of its
/// pieces, so that parallel ones, which overlap everywhere, have flat boxes one behind the other.
class PieceBoxes {
 public:
  /// `pieces` by their places in `members`.
  PieceBoxes(const Pieces& all, const std::vector<std::uint32_t>& members, std::span<const std::uint32_t> pieces);

  /// How many from the `first` on surely lie wholly on the positive side of a plane. Fewer than there are: only boxes
  /// that begin there are asked.
  [[nodiscard]] std::size_t count_before(std::size_t first, const Plane& plane) const;

 private:
  struct Box {
    glm::dvec3 centre;
    std::array<glm::dvec3, 3> halves;  ///< from the centre to a side
    double slack;                      ///< by which any coordinate of its pieces may be farther
  };
  static Box box_of(const Pieces& all, const std::vector<std::uint32_t>& members,
                    std::span<const std::uint32_t> pieces);

  std::size_t count_;
  std::vector<std::vector<Box>> levels_;  ///< the smallest boxes first
};

}  // namespace frontmost::painter_detail
