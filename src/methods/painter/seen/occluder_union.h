// SPDX-License-Identifier: Apache-2.0
// Whether the union of adjacent occluders hides an outline, found without any clipping.
//
// Clipping would also tell, but it makes parts and corners for every occluder. Most hidden polygons are hidden by a
// piece of one mesh, whose sides lead from triangle to triangle; then nothing needs to be cut.
//
//        +---------------+       Occluder 1 hides a point of the outline. Its sides lead to 2, from there to 3,
//        |  1  / 2 \ 3   |       and so on, as long as they cross the outline. If a side that crosses has no
//        |    / ..... \  |       occluder beyond it, the outline shows there.
//        |   / outline \ |
//        +---------------+
#pragma once

#include <algorithm>
#include <vector>

#include "painter/seen/adjacency.h"

namespace frontmost::painter_detail {

/// A convex outline, prepared for finding the sides of others that cross it.
class CoveredOutline {
 public:
  void set(Outline outline);

  /// The part of the way from a to b that lies within the outline.
  struct Crossing {
    double from, to;
    [[nodiscard]] bool is_any() const { return from < to; }
  };
  /// Empty if the way goes less deep into the outline than OutlineClipper::thin.
  [[nodiscard]] Crossing crossing(const glm::dvec2& a, const glm::dvec2& b) const;

 private:
  struct Side {
    glm::dvec2 from, way;
    double slack;  ///< turn of a point that is OutlineClipper::thin away
  };
  [[nodiscard]] bool is_beside_box(const glm::dvec2& a, const glm::dvec2& b) const {
    return (a.x <= low_.x && b.x <= low_.x) || (a.x >= high_.x && b.x >= high_.x) || (a.y <= low_.y && b.y <= low_.y) ||
           (a.y >= high_.y && b.y >= high_.y);
  }

  std::vector<Side> sides_;
  glm::dvec2 low_{0}, high_{0};
};

/// Grows a union of occluders, from one that lies over a point of an outline, across the sides that cross the outline.
/// If an occluder lies beyond each such side, the union hides all of the outline: an open part would have a border,
/// which would be a side without an occluder beyond it. Not for several threads at once.
class OccluderUnion {
 public:
  OccluderUnion(const ScreenPolygons& screen, const Adjacency& adjacency)
      : screen_(screen), adjacency_(adjacency), asked_(screen.count(), 0) {}

  enum class Found : std::uint8_t {
    hidden,
    open,     ///< but at open_at()
    unknown,  ///< there are too many occluders
  };
  /// Selects the outline to test.
  void set(Outline outline) { outline_.set(outline); }
  /// Grows from the slot `first`, which hides a point of the outline. hiders.may_hide(slot) says whether a polygon is
  /// an occluder of the outline. hiders.at(place) gives the slot of an occluder at a place, or no_index.
  template <class Hiders>
  Found spread(std::uint32_t first, const Hiders& hiders) {
    begin(first);
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
    std::size_t from;  ///< number of the one before it; of the first one its own
  };

  void begin(std::uint32_t first);
  [[nodiscard]] bool is_found(std::uint32_t slot) const { return asked_[slot] == turn_; }
  void add(std::uint32_t slot, std::size_t from) {
    asked_[slot] = turn_;
    found_.push_back({slot, from});
  }

  /// Looks for occluders beyond a side of found_[number] without a neighbour, step by step: meshes that were cut have
  /// sides that lie beside two others.
  template <class Hiders>
  Found step_along(const glm::dvec2& a, const glm::dvec2& b, std::size_t number, const Hiders& hiders) {
    const glm::dvec2 way = b - a, out = beyond(way), from = a + out;
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
  /// Offset from a side to points that are certainly not on it: polygons hide points up to OutlineClipper::thin beside
  /// them.
  static glm::dvec2 beyond(const glm::dvec2& way);
  /// An occluder among those found that lies over a place; `likely` is tried first.
  [[nodiscard]] std::uint32_t found_at(const glm::dvec2& place, std::size_t likely) const;
  /// The share of a way at which it leaves an outline widened by OutlineClipper::thin.
  static double end_within(Outline outline, const glm::dvec2& from, const glm::dvec2& way);

  const ScreenPolygons& screen_;
  const Adjacency& adjacency_;
  CoveredOutline outline_;
  std::vector<Reached> found_;
  std::vector<std::uint32_t> asked_;  ///< by slot: the turn in which it was found last
  std::uint32_t turn_ = 0;
  glm::dvec2 open_at_{0};
};

}  // namespace frontmost::painter_detail
