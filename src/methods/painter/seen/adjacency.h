// SPDX-License-Identifier: Apache-2.0
// Finds which polygons share a side, as polygons of a mesh do, and which polygons no other polygon overlaps on the
// screen. The latter is found from the few sides without a neighbour.
//
//           ____ ____          The side that both squares share runs down in one and up in the other. The neighbour
//          |    ^    |         lies across it, and a walk over the screen continues there. Sides at the rim have no
//          |   | |   |         neighbour and are called open. Only at an open side may something begin or end, so
//          |____v____|         only there may the number of polygons over a point of the screen change.
#pragma once

#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "painter/limits.h"
#include "painter/seen/screen_polygons.h"

namespace frontmost::painter_detail {

/// The adjacency of polygons on the screen. Two polygons are adjacent if both have the same side, to the bit, in
/// opposite directions. Both are convex and counter-clockwise, so they touch there and do not overlap.
class Adjacency {
 public:
  explicit Adjacency(const ScreenPolygons& screen);

  /// Returns the slot of the polygon across a side, or no_index. The side is given by its first corner in
  /// ScreenPolygons::corners().
  [[nodiscard]] std::uint32_t across(std::size_t corner) const { return across_[corner]; }

 private:
  std::vector<std::uint32_t> across_;
};

/// Returns, by slot, 1 if certainly no other polygon overlaps the polygon in it. Polygons with `gone[slot]` do not
/// count; an empty `gone` means that none is gone. If polygons share few sides, none is found.
[[nodiscard]] std::vector<std::uint8_t> find_unoverlapped(const ScreenPolygons& screen, const Adjacency& adjacency,
                                                          const std::vector<std::uint8_t>& gone, PaintEffort& effort);

/// A convex outline, prepared for finding the sides of other polygons that cross it.
class CoveredOutline {
 public:
  void set(Outline outline) {
    sides_.clear();
    low_ = high_ = glm::dvec2(outline[0].at);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const glm::dvec2 from(outline[i].at), way = glm::dvec2(outline[i + 1 == outline.size() ? 0 : i + 1].at) - from;
      // Cuts at a corner leave the corner twice, and nothing would be within a side of no length.
      if (const double length = glm::length(way); length >= shortest_side)
        sides_.push_back({from, way, OutlineClipper::thin * length});
      low_ = glm::min(low_, from);
      high_ = glm::max(high_, from);
    }
  }

  /// The part of the way from a to b that lies within the outline.
  struct Crossing {
    double from, to;
    [[nodiscard]] bool is_any() const { return from < to; }
  };
  /// Returns an empty crossing if the way goes less deep into the outline than OutlineClipper::thin.
  [[nodiscard]] Crossing crossing(const glm::dvec2& a, const glm::dvec2& b) const {
    constexpr Crossing none{1, 0};
    if ((a.x <= low_.x && b.x <= low_.x) || (a.x >= high_.x && b.x >= high_.x) || (a.y <= low_.y && b.y <= low_.y) ||
        (a.y >= high_.y && b.y >= high_.y))
      return none;
    Crossing crossing{0, 1};
    const glm::dvec2 way = b - a;
    double least = 0, greatest = 0;
    for (const Side& side : sides_) {
      const double at_a = turn(side.way, a - side.from), at_b = turn(side.way, b - side.from);
      if (at_a >= -side.slack && at_b >= -side.slack) return none;
      if (at_a > 0) crossing.from = std::max(crossing.from, at_a / (at_a - at_b));
      if (at_b > 0) crossing.to = std::min(crossing.to, at_a / (at_a - at_b));
      const double corner = turn(way, side.from - a);
      least = std::min(least, corner);
      greatest = std::max(greatest, corner);
    }
    const double depth = std::min(-least, greatest);
    if (depth * depth <= OutlineClipper::thin * OutlineClipper::thin * glm::dot(way, way)) return none;
    return crossing;
  }

 private:
  struct Side {
    glm::dvec2 from, way;
    double slack;  ///< turn of a point that is OutlineClipper::thin away
  };

  std::vector<Side> sides_;
  glm::dvec2 low_{0}, high_{0};
};

/// Grows a union of adjacent occluders, from one that lies over a point of an outline, across the sides that cross the
/// outline:
///
///        +---------------+       Occluder 1 hides a point of the outline. Its sides lead to 2, from there to 3,
///        |  1  / 2 \ 3   |       and so on, as long as they cross the outline. If a side that crosses has no
///        |    / ..... \  |       occluder beyond it, the outline shows there.
///        |   / outline \ |
///        +---------------+
///
/// Clipping would give the answer, too, but it makes parts and corners for every occluder. Most hidden polygons are
/// hidden by a piece of one mesh, so that nothing needs to be cut. All comparisons have the same slack,
/// OutlineClipper::thin, so hairlines between neighbours, which rounding leaves, do not open a union.
///
/// If an occluder lies beyond each such side, the union hides all of the outline: an open part would have a border,
/// which would be a side without an occluder beyond it. Not for several threads at once.
class OccluderUnion {
 public:
  OccluderUnion(const ScreenPolygons& screen, const Adjacency& adjacency)
      : screen_(screen), adjacency_(adjacency), asked_(screen.count(), 0) {}

  enum class Found : std::uint8_t {
    hidden,
    open,     ///< not hidden at open_at()
    unknown,  ///< there are too many occluders
  };
  /// Selects the outline to test.
  void set(Outline outline) { outline_.set(outline); }
  /// Grows from the slot `first`, which hides a point of the outline. hiders.may_hide(slot) says whether a polygon is
  /// an occluder of the outline. hiders.at(place) gives the slot of an occluder at a place, or no_index.
  template <class Hiders>
  Found spread(std::uint32_t first, const Hiders& hiders) {
    if (++turn_ == 0) {
      std::fill(asked_.begin(), asked_.end(), 0);
      turn_ = 1;
    }
    found_.clear();
    add(first, 0);
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const Reached reached = found_[i];
      const Outline over = screen_.outline(reached.slot);
      const std::size_t corner = screen_.first_corner(reached.slot);
      for (std::size_t side = 0; side < over.size(); ++side) {
        const std::uint32_t across = adjacency_.across(corner + side);
        if (across != no_index && is_found(across)) continue;
        const glm::dvec2 a(over[side].at), b(over[side + 1 == over.size() ? 0 : side + 1].at);
        if (across != no_index && !outline_.crossing(a, b).is_any()) continue;
        if (across != no_index && hiders.may_hide(across)) {
          add(across, i);
        } else if (const Found found = step_along(a, b, i, hiders); found != Found::hidden) {
          return found;
        }
        if (found_.size() > most) return Found::unknown;
      }
    }
    return Found::hidden;
  }
  [[nodiscard]] const glm::dvec2& open_at() const { return open_at_; }

 private:
  /// Limit of polygons, and of steps along their sides.
  static constexpr std::size_t most = 256;

  struct Reached {
    std::uint32_t slot;
    std::size_t from;  ///< index in found_ of the occluder that it was reached from; for the first one its own
  };

  [[nodiscard]] bool is_found(std::uint32_t slot) const { return asked_[slot] == turn_; }
  void add(std::uint32_t slot, std::size_t from) {
    asked_[slot] = turn_;
    found_.push_back({slot, from});
  }

  /// Looks, step by step, for occluders beyond a side of found_[number] that has no neighbour: in meshes that were cut,
  /// a side may lie beside two others.
  template <class Hiders>
  Found step_along(const glm::dvec2& a, const glm::dvec2& b, std::size_t number, const Hiders& hiders) {
    // Polygons hide points up to OutlineClipper::thin beside them, so points twice as far out are certainly beyond the
    // side.
    const glm::dvec2 way = b - a, out = glm::dvec2(-way.y, way.x) * (2 * OutlineClipper::thin / glm::length(way));
    const glm::dvec2 from = a + out;
    const CoveredOutline::Crossing crossing = outline_.crossing(from, b + out);
    const double step = OutlineClipper::thin / glm::length(way);
    double at = crossing.from;
    for (std::size_t steps = 0; at < crossing.to; ++steps) {
      if (steps == most) return Found::unknown;
      const glm::dvec2 place = from + way * std::min(at + step, 0.5 * (at + crossing.to));
      std::uint32_t hider = found_at(place, found_[number].from);
      if (hider == no_index) {
        hider = hiders.at(place);
        open_at_ = place;
        if (hider == no_index) return Found::open;
        if (!is_found(hider)) add(hider, number);
      }
      at = std::max(end_within(screen_.outline(hider), from, way), at + step);
    }
    return Found::hidden;
  }
  /// Returns an occluder among those found that lies over a place, or no_index. `likely` is tried first.
  [[nodiscard]] std::uint32_t found_at(const glm::dvec2& place, std::size_t likely) const {
    const auto holds = [&](std::size_t i) { return is_within(screen_.outline(found_[i].slot), place, 0); };
    if (holds(likely)) return found_[likely].slot;
    for (std::size_t i = found_.size(); i-- > 0;)
      if (i != likely && holds(i)) return found_[i].slot;
    return no_index;
  }
  /// Returns the share of a way at which it leaves an outline that is widened by OutlineClipper::thin.
  static double end_within(Outline outline, const glm::dvec2& from, const glm::dvec2& way) {
    double end = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const glm::dvec2 p(outline[i].at), side = glm::dvec2(outline[i + 1 == outline.size() ? 0 : i + 1].at) - p;
      const double beside = OutlineClipper::thin * glm::length(side) - turn(side, from - p), change = turn(side, way);
      if (change > 0) end = std::min(end, beside / change);
    }
    return end;
  }

  const ScreenPolygons& screen_;
  const Adjacency& adjacency_;
  CoveredOutline outline_;
  std::vector<Reached> found_;
  std::vector<std::uint32_t> asked_;  ///< by slot: the turn in which it was found last
  std::uint32_t turn_ = 0;
  glm::dvec2 open_at_{0};
};

}  // namespace frontmost::painter_detail
