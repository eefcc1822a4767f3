// SPDX-License-Identifier: Apache-2.0
// Inside of a machine nearly everything is hidden by what is not, and takes most of the time to be put into order:
// there its parts pass through each other. Which of two is before the other where they overlap needs no order where one
// of Newell's plane tests tells it. The foremost of all at any point of the screen is hidden by nothing, so that what
// is hidden may well hide others.
#include "painter/hidden.h"

#include <algorithm>

#include "base/pool.h"
#include "painter/emit.h"
#include "painter/looker.h"

namespace frontmost::painter_detail {
namespace {

constexpr std::size_t kPerPart = 1024;

/// By nearest points, the nearest last: what is before another is mostly after it here.
std::vector<std::uint32_t> sorted_by_nearest(const Pieces& pieces, std::vector<std::uint32_t> members) {
  std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    const float depth_a = pieces.extent(a).nearest, depth_b = pieces.extent(b).nearest;
    return depth_a != depth_b ? depth_a > depth_b : pieces.face(a).id > pieces.face(b).id;
  });
  return members;
}

/// Whether one piece is surely before another wherever they overlap on the screen.
bool is_before(const Pieces& pieces, std::uint32_t piece, std::uint32_t other) {
  if (pieces.extent(piece).farthest <= pieces.extent(other).nearest) return true;
  bool is_flat = false;
  if (pieces.keeps_off(piece, pieces.face(other).plane(), -1, is_flat))
    return !is_flat || pieces.face(piece).id < pieces.face(other).id;
  return pieces.keeps_off(other, pieces.face(piece).plane(), 1, is_flat);
}

}  // namespace

std::vector<std::uint32_t> without_hidden(const Pieces& pieces, const std::vector<std::uint32_t>& members,
                                          const View& view, const std::function<bool(PrimitiveId)>& hides,
                                          const Execution& execution) {
  const std::vector<std::uint32_t> sorted = sorted_by_nearest(pieces, members);
  PaintOrder naive;
  naive.view = view;
  Poll poll(execution);
  emit(pieces, sorted, naive, poll);
  const Scenery scenery(naive, hides);
  const auto is_behind = [&](std::uint32_t place, std::uint32_t cover) {
    return is_before(pieces, sorted[cover], sorted[place]);
  };
  std::vector<std::uint8_t> is_hidden(pieces.size(), 0);
  Pool<Looker> lookers;
  parallel_for(execution, scenery.count(), kPerPart, [&](std::size_t begin, std::size_t end) {
    const auto looker = lookers.borrow([&] { return std::make_unique<Looker>(scenery, execution, is_behind); });
    for (std::size_t slot = begin; slot < end; ++slot)
      is_hidden[sorted[scenery.place(slot)]] = looker->is_all_hidden(slot);
  });
  std::vector<std::uint32_t> left;
  for (const std::uint32_t piece : members)
    if (!is_hidden[piece]) left.push_back(piece);
  return left;
}

}  // namespace frontmost::painter_detail
