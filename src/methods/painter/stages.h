// SPDX-License-Identifier: Apache-2.0
// The stages of painter(), each a function from pieces to pieces:
//
//   Surfaces, View
//        |  gather            the triangles that the view may show, cut at the near and the far plane
//        |  Copies            triangles in one another's place are taken out, all but one
//        |  without_hidden    for figures: what is hidden is left out, what nothing overlaps goes first
//        v
//     pieces --depth_sort--> groups: of one piece, painted as it is
//        ^                           of several without an order among them --part--> two halves, and what is within
//        |                                                                                |        the plane
//        +--------------------------------------------------------------------------------+
//        |
//        |  put_back          copies come back, directly below the one that stayed
//        v
//     PaintOrder
//
// Pieces stay where they are, in Pieces; what goes from stage to stage are lists of their numbers, here `members`.
#pragma once

#include <vector>

#include "frontmost/painter.h"
#include "painter/limits.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// Appends the triangles that a view may show, in the order of their ids, cut at the near and the far plane.
/// \returns their numbers.
[[nodiscard]] std::vector<std::uint32_t> gather(const Surfaces& surfaces, const View& view, Pieces& pieces,
                                                const Execution& execution);

/// Triangles that lie in one another's place: exporters write faces twice, and models are placed twice. Of triangles
/// with the same corners one alone is put into order and cut, that of the lowest id: it is on top of the others, which
/// lie wherever it lies.
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

/// What occluders leave of a list of pieces, in its order.
struct Unhidden {
  std::vector<std::uint32_t> unoverlapped;  ///< no other one is over or under any part of them
  std::vector<std::uint32_t> others;
};

/// Leaves out most that occluders hide together, before anything is in order. Precondition: pieces of different
/// triangles.
[[nodiscard]] Unhidden without_hidden(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                                      const Occluders& occluders, PaintEffort& effort);

/// Pieces one after another, in groups: a group of one can be painted whole, those of more have to be cut. Every group
/// covers only those before it.
struct Groups {
  std::vector<std::uint32_t> pieces;
  std::vector<std::size_t> ends;
};

/// Pieces in the order of painting, as far as they have one. Reports progress where `is_all`: these are all the pieces
/// that there are.
[[nodiscard]] Groups depth_sort(const Pieces& pieces, const std::vector<std::uint32_t>& members, bool is_all,
                                PaintSteps& steps, Poll& poll);

/// By farthest points, the farthest first, then by id.
void sort_by_farthest(const Pieces& pieces, std::vector<std::uint32_t>& members, const Execution& execution);

/// What is behind, in and before a plane, as the eye sees it: to be painted in this order, `within` as it stands.
struct Partition {
  std::vector<std::uint32_t> behind, within, before;
};

/// By the plane of one of `members`, which cuts as few of the others as those that were tried. Neither side is as many
/// as the members were. Of what is cut, one half takes its number and the other a new one.
[[nodiscard]] Partition part(Pieces& pieces, const std::vector<std::uint32_t>& members, PaintSteps& steps, Poll& poll);

/// The least number of cuts that a list of whole triangles and pieces takes, for those of them that pass through each
/// other; as far as a few hundred pairs tell: it may be too great once in ten thousand times.
[[nodiscard]] double least_cuts(const Pieces& pieces, const std::vector<std::uint32_t>& members, Poll& poll);

}  // namespace frontmost::painter_detail
