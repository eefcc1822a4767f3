// SPDX-License-Identifier: Apache-2.0
// Inside of a machine nearly everything is hidden by what is not, and takes most of the time to be put into order:
// there its parts pass through each other. Which of two is before the other where they overlap needs no order where one
// of Newell's plane tests tells it. The foremost of all at any point of the screen is hidden by nothing, so that what
// is hidden may well hide others.
#include "painter/seen/hidden.h"

#include <algorithm>

#include "base/pool.h"
#include "painter/order/by_depth.h"
#include "painter/seen/occlusion_clipper.h"
#include "painter/seen/unoverlapped.h"

namespace frontmost::painter_detail {
namespace {

constexpr std::size_t kPerPart = 1024;

/// Whether one piece is surely before another wherever they overlap on the screen.
bool is_before(const Pieces& pieces, std::uint32_t piece, std::uint32_t other) {
  if (pieces.extent(piece).farthest <= pieces.extent(other).nearest) return true;
  bool is_flat = false;
  if (pieces.keeps_off(piece, pieces.face(other).plane(), -1, is_flat))
    return !is_flat || pieces.face(piece).id < pieces.face(other).id;
  return pieces.keeps_off(other, pieces.face(piece).plane(), 1, is_flat);
}

}  // namespace

Unhidden without_hidden(const Pieces& pieces, const std::vector<std::uint32_t>& members, const View& view,
                        const std::function<bool(PrimitiveId)>& hides, const Execution& execution) {
  // The nearest last: what is before another is mostly after it here.
  std::vector<std::uint32_t> sorted = members;
  sort_by_depth(
      pieces, sorted, [&](std::uint32_t piece) { return pieces.extent(piece).nearest; }, execution);
  const ScreenPolygons screen(pieces, sorted, view, hides);
  const Adjacency adjacency(screen);
  const auto is_behind = [&](std::uint32_t place, std::uint32_t cover) {
    return is_before(pieces, sorted[cover], sorted[place]);
  };
  std::vector<std::uint8_t> is_hidden(screen.count(), 0);
  Pool<OcclusionClipper> clippers;
  parallel_for(execution, screen.count(), kPerPart, [&](std::size_t begin, std::size_t end) {
    const auto clipper =
        clippers.borrow([&] { return std::make_unique<OcclusionClipper>(screen, adjacency, execution, is_behind); });
    for (std::size_t slot = begin; slot < end; ++slot) is_hidden[slot] = clipper->is_all_hidden(slot);
  });
  const std::vector<std::uint8_t> is_alone = find_unoverlapped(screen, adjacency, is_hidden, execution);
  Unhidden left;
  std::vector<std::uint8_t> is_other(pieces.size(), 0);
  for (std::size_t slot = 0; slot < screen.count(); ++slot) {
    const std::uint32_t piece = sorted[screen.place(slot)];
    if (is_alone[slot]) left.alone.push_back(piece);
    is_other[piece] = !is_hidden[slot] && !is_alone[slot];
  }
  for (const std::uint32_t piece : members)
    if (is_other[piece]) left.others.push_back(piece);
  return left;
}

}  // namespace frontmost::painter_detail
