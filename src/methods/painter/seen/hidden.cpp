// SPDX-License-Identifier: Apache-2.0
// Inside a machine nearly everything is hidden. Ordering the hidden parts would take most of the time, because parts
// pass through each other there. One of Newell's plane tests often tells which of two pieces is before the other
// wherever they overlap, so that no order is needed. A hidden piece may count as an occluder of others: at any point of
// the screen the foremost piece is hidden by nothing, so not all pieces are left out.
#include <algorithm>

#include "base/pool.h"
#include "painter/order/by_depth.h"
#include "painter/seen/adjacency.h"
#include "painter/seen/occlusion_clipper.h"
#include "painter/stages.h"

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
                        const Occluders& occluders, PaintEffort& effort) {
  const Execution& execution = effort.execution();
  // The nearest piece comes last, so a piece that is before another mostly comes after it.
  std::vector<std::uint32_t> sorted = members;
  sort_by_depth(
      pieces, sorted, [&](std::uint32_t piece) { return pieces.extent(piece).nearest; }, execution);
  const ScreenPolygons screen(pieces, sorted, view, occluders);
  const Adjacency adjacency(screen);
  const auto is_behind = [&](std::uint32_t place, std::uint32_t cover) {
    return is_before(pieces, sorted[cover], sorted[place]);
  };
  std::vector<std::uint8_t> is_hidden(screen.count(), 0);
  Pool<OcclusionClipper> clippers;
  parallel_for(execution, screen.count(), kPerPart, [&](std::size_t begin, std::size_t end) {
    const auto clipper =
        clippers.borrow([&] { return std::make_unique<OcclusionClipper>(screen, adjacency, effort, is_behind); });
    for (std::size_t slot = begin; slot < end; ++slot) is_hidden[slot] = clipper->is_hidden(slot);
  });
  const std::vector<std::uint8_t> is_unoverlapped = find_unoverlapped(screen, adjacency, is_hidden, effort);
  Unhidden left;
  std::vector<std::uint8_t> is_other(pieces.size(), 0);
  for (std::size_t slot = 0; slot < screen.count(); ++slot) {
    const std::uint32_t piece = sorted[screen.place(slot)];
    if (is_unoverlapped[slot]) left.unoverlapped.push_back(piece);
    is_other[piece] = !is_hidden[slot] && !is_unoverlapped[slot];
  }
  for (const std::uint32_t piece : members)
    if (is_other[piece]) left.others.push_back(piece);
  return left;
}

}  // namespace frontmost::painter_detail
