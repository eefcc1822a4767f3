// SPDX-License-Identifier: Apache-2.0
// The stages of painter(), each a function from pieces to pieces. Pieces stay in place in Pieces; stages pass on lists
// of their numbers, here called `members`.
//
//   gather           the triangles that the view may show, cut at the near and the far plane, without copies
//   without_hidden   for figures: hidden pieces are left out, pieces that nothing overlaps go first
//   depth_sort       groups: of one piece, which is painted as it is, or of several pieces without an order
//   part             two halves of such a group, which are sorted again, and the pieces within the plane between them
#pragma once

#include <vector>

#include "frontmost/painter.h"
#include "painter/limits.h"
#include "painter/pieces.h"

namespace frontmost::painter_detail {

/// Appends the triangles that a view may show, in the order of their ids, cut at the near and the far plane. \returns
/// their numbers.
[[nodiscard]] std::vector<std::uint32_t> gather(const Surfaces& surfaces, const View& view, Pieces& pieces,
                                                const Execution& execution);

/// The pieces of a list that occluders do not hide.
struct Unhidden {
  std::vector<std::uint32_t> unoverlapped;  ///< no other piece overlaps them on the screen
  std::vector<std::uint32_t> others;        ///< in the order of the list
};

/// Leaves out most of the pieces that occluders hide together. Pieces need no order for this. Precondition: no two
/// pieces belong to one triangle.
[[nodiscard]] Unhidden without_hidden(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                                      const Occluders& occluders, PaintEffort& effort);

/// Pieces in the order of painting, in groups. A group of one piece can be painted as it is; larger groups must be cut.
/// A group covers only groups before it.
struct Groups {
  std::vector<std::uint32_t> pieces;
  std::vector<std::size_t> ends;
};

/// Sorts pieces into the order of painting, as far as they have one. `is_all` says that the members are all pieces;
/// progress is then reported.
[[nodiscard]] Groups depth_sort(const Pieces& pieces, const std::vector<std::uint32_t>& members, bool is_all,
                                PaintSteps& steps, Poll& poll);

/// Sorts pieces by their nearest, or by their farthest, points: the farthest first, then by id.
void sort_by_nearest(const Pieces& pieces, std::vector<std::uint32_t>& members, const Execution& execution);
void sort_by_farthest(const Pieces& pieces, std::vector<std::uint32_t>& members, const Execution& execution);

/// Pieces behind, within and in front of a plane, as the eye sees it. They are to be painted in this order; `within` is
/// in order already.
struct Partition {
  std::vector<std::uint32_t> behind, within, before;
};

/// Parts members by the plane of one of them, chosen among a few planes because it cuts few others. Neither side is as
/// large as `members`. When a piece is cut, one half keeps its number and the other half gets a new one.
[[nodiscard]] Partition part(Pieces& pieces, const std::vector<std::uint32_t>& members, PaintSteps& steps, Poll& poll);

/// Returns a lower bound of the number of cuts that a list needs because its triangles pass through each other. The
/// bound is estimated from a few hundred pairs, and may be too great once in ten thousand times.
[[nodiscard]] double least_cuts(const Pieces& pieces, const std::vector<std::uint32_t>& members, Poll& poll);

}  // namespace frontmost::painter_detail
