// SPDX-License-Identifier: Apache-2.0
// Traps as corners of an outline. Places are measured along a side and across it:
//
//    along 0                              along = length of the side
//       |      .____________.                |        Between two corners the outline follows the knots. A strip
//       |    ./              \.              |        that goes around a corner shares its last point with the
//    ===+===================================+===      strip of the next side, and the corner itself is left out.
//     from                                   to
//
// After neighbours are merged, only a part of a side may be left. Its strip is written whole and then cut at the ends
// of that part, across the side.
#include "painter/traps/trap.h"

#include <algorithm>
#include <cmath>

#include "painter/seen/slot_lists.h"

namespace frontmost::painter_detail {
namespace {

/// Distance at which a strip begins from a corner that it does not go around: relative to its height, but at most this
/// share of the way to the next knot.
constexpr double kInset = 0.5, kMostInset = 0.45;

/// Pixels. A part of a side that ends this close to the end of the whole side ends there: both may have been rounded.
constexpr double kAtEnd = 1.0 / 1024;

bool is_at(const glm::dvec2& a, const glm::dvec2& b) { return glm::length(a - b) <= kAtEnd; }

/// A strip that ends at a corner ends before it: otherwise its rim would run along open places around the corner.
TrapKnot inset(const TrapKnot& end, const TrapKnot& beside) {
  const double way = beside.along - end.along, part = std::min(kInset * end.height / std::abs(way), kMostInset);
  return {end.along + part * way, end.height + part * (beside.height - end.height)};
}

void write_whole(const TrapList& list, const Trap& trap, std::vector<glm::dvec2>& corners) {
  const glm::dvec2 way = trap.to - trap.from, along = way / glm::length(way), out = outwards(along);
  const std::span<const TrapKnot> knots = list.knots_of(trap);
  if (const double reach = trap.at_from.reach; reach > 0) {
    const TrapCorner corner{trap.at_from.beyond, along};
    corners.push_back(trap.from + corner.meeting_point(reach));
    if (corner.is_sharp()) corners.push_back(trap.from + (out - along) * reach);
  }
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const bool is_first = i == 0, is_last = i + 1 == knots.size(), is_end = is_first || is_last;
    const double reach = is_first ? trap.at_from.reach : is_last ? trap.at_to.reach : 0;
    // The knot lies on the side, or on the way around the corner.
    if (is_end && (knots[i].height < least_trap_height || knots[i].height == reach)) continue;
    const TrapKnot knot = is_end && reach == 0 ? inset(knots[i], knots[is_first ? 1 : i - 1]) : knots[i];
    corners.push_back(trap.from + along * knot.along + out * knot.height);
  }
  if (const double reach = trap.at_to.reach; reach > 0) {
    const TrapCorner corner{along, trap.at_to.beyond};
    if (corner.is_sharp()) corners.push_back(trap.to + (out + along) * reach);
    corners.push_back(trap.to + corner.meeting_point(reach));
  }
}

/// Removes the corners from number `first` on that lie before a line across the side through `at`, and adds the point
/// where the strip, which begins at `end`, crosses that line.
void cut_beginning(std::vector<glm::dvec2>& corners, std::size_t first, const glm::dvec2& at, const glm::dvec2& along,
                   const glm::dvec2& end) {
  const auto beyond = [&](const glm::dvec2& p) { return glm::dot(p - at, along); };
  std::size_t kept = first;
  glm::dvec2 before = end;
  while (kept < corners.size() && beyond(corners[kept]) < 0) before = corners[kept++];
  if (kept == corners.size()) return corners.resize(first);
  const double a = beyond(before), b = beyond(corners[kept]);
  const glm::dvec2 crossing = before + (corners[kept] - before) * (a / (a - b));
  corners.erase(corners.begin() + std::ptrdiff_t(first), corners.begin() + std::ptrdiff_t(kept));
  corners.insert(corners.begin() + std::ptrdiff_t(first), crossing);
}

/// Writes the corners of a strip that follow `from` on the way to `to`, a part of its side.
void write_trap(const TrapList& list, const Trap& trap, const glm::dvec2& from, const glm::dvec2& to,
                std::vector<glm::dvec2>& corners) {
  const std::size_t first = corners.size();
  write_whole(list, trap, corners);
  const glm::dvec2 way = trap.to - trap.from, along = way / glm::length(way);
  if (!is_at(from, trap.from)) cut_beginning(corners, first, from, along, trap.from);
  if (is_at(to, trap.to)) return;
  const auto turn_around = [&] { std::reverse(corners.begin() + std::ptrdiff_t(first), corners.end()); };
  turn_around();
  cut_beginning(corners, first, to, -along, trap.to);
  turn_around();
}

/// Whether the strips of two consecutive sides go around the corner between them: the end of the first coincides with
/// the beginning of the second.
bool go_around(const Trap& first, const Trap& second, const glm::dvec2& corner) {
  return second.at_from.reach > 0 && first.polygon == second.polygon && is_at(corner, second.from);
}

}  // namespace

void TrapList::reserve(const std::vector<TrapList>& lists) {
  reserve_sum(traps, lists, &TrapList::traps);
  reserve_sum(knots, lists, &TrapList::knots);
}

void TrapList::add_polygon(const TrapList& other, std::size_t polygon) {
  for (Trap trap : other.of(polygon)) {
    const std::span<const TrapKnot> own = other.knots_of(trap);
    trap.polygon = std::uint32_t(ends.size());
    trap.first_knot = knots.size();
    knots.insert(knots.end(), own.begin(), own.end());
    traps.push_back(trap);
  }
  ends.push_back(traps.size());
}

glm::dvec2 TrapCorner::meeting_point(double width) const {
  const double turned = glm::dot(to, from);
  if (turned >= 0) return (outwards(to) + outwards(from)) * (width / (1 + turned));
  const double cotangent = std::sqrt(std::max(1 + turned, 0.0) / (1 - turned));  // of half the turning angle
  return (to - from) * (0.5 * width * (1 + cotangent));
}

void TrapList::set_corners(std::size_t polygon, std::span<const glm::dvec2> outline,
                           std::vector<TrappedCorner>& corners) const {
  corners.clear();
  for (const glm::dvec2& at : outline) corners.push_back({at});
  const std::span<const Trap> own = of(polygon);
  for (const Trap& trap : own) corners[trap.side].trap = std::uint32_t(&trap - traps.data());
}

void write_outline(const TrapList& list, std::span<const TrappedCorner> outline, std::vector<glm::dvec2>& corners) {
  const Trap* before = nullptr;  // the trap that ends at the corner
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 &from = outline[i].at, &to = outline[i + 1 == outline.size() ? 0 : i + 1].at;
    const Trap* const trap = outline[i].trap == no_trap ? nullptr : &list.traps[outline[i].trap];
    corners.push_back(from);
    const std::size_t end = corners.size();
    if (trap) write_trap(list, *trap, from, to, corners);
    const bool is_written = corners.size() > end;
    // The corner lies within both strips.
    if (is_written && before && go_around(*before, *trap, from))
      corners.erase(corners.begin() + std::ptrdiff_t(end) - 1, corners.begin() + std::ptrdiff_t(end) + 1);
    before = is_written ? trap : nullptr;
  }
}

}  // namespace frontmost::painter_detail
