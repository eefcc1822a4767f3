// SPDX-License-Identifier: Apache-2.0
// Whether polygons that lie side by side hide an outline together, told without cutting anything.
#pragma once

#include <vector>

#include "painter/seen/mosaic.h"

namespace frontmost::painter_detail {

/// A convex outline, made ready to ask which sides of others cross it.
class SpreadOutline {
 public:
  void set(Outline outline);

  /// How much of the way from a to b is within the outline.
  struct Crossing {
    double from, to;
    [[nodiscard]] bool is_any() const { return from < to; }
  };
  /// None where the way is less deep in there than OutlineCutter::thin.
  [[nodiscard]] Crossing crossing(const glm::dvec2& a, const glm::dvec2& b) const;
  [[nodiscard]] bool holds(const glm::dvec2& at) const;

 private:
  struct Side {
    glm::dvec2 from, way;
    double slack;  ///< of turns: where a point is OutlineCutter::thin away
  };
  std::vector<Side> sides_;
};

/// Spreads from a polygon over those across its sides as far as an outline reaches. As many of them lie over one point
/// of it as over any other, as long as every side that crosses it is that of two, once to and once fro. So where the
/// first one lies over a point, and none of those across is missing, they hide all of it. Not for several threads at
/// once.
class Spreader {
 public:
  Spreader(const Scenery& scenery, const Mosaic& mosaic)
      : scenery_(scenery), mosaic_(mosaic), asked_(scenery.count(), 0) {}

  enum class Found : std::uint8_t {
    hidden,
    open,     ///< beyond a side there is none that hides; open_at() is there
    unknown,  ///< there are too many, or the place beyond the side is too narrow
  };
  /// `first` is a slot that hides a point of the outline; may_hide(slot) says which others do where they lie.
  template <class MayHide>
  Found spread(Outline outline, std::uint32_t first, const MayHide& may_hide) {
    begin(outline, first);
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const Outline over = scenery_.outline(found_[i]);
      const std::size_t corner = scenery_.first_corner(found_[i]);
      for (std::size_t side = 0; side < over.size(); ++side) {
        const std::uint32_t across = mosaic_.across(corner + side);
        if (across != no_index && asked_[across] == turn_) continue;
        const glm::dvec2 a(over[side].at), b(over[side + 1 == over.size() ? 0 : side + 1].at);
        const SpreadOutline::Crossing crossing = outline_.crossing(a, b);
        if (!crossing.is_any()) continue;
        if (across == no_index || !may_hide(across)) return beyond(a, b, crossing);
        if (found_.size() == most) return Found::unknown;
        asked_[across] = turn_;
        found_.push_back(across);
      }
    }
    return Found::hidden;
  }
  [[nodiscard]] const glm::dvec2& open_at() const { return open_at_; }

 private:
  /// Polygons: those that lie over many small ones are cut by them.
  static constexpr std::size_t most = 256;

  void begin(Outline outline, std::uint32_t first);
  /// Sets open_at_ to a place next to the side from a to b.
  Found beyond(const glm::dvec2& a, const glm::dvec2& b, const SpreadOutline::Crossing& crossing);

  const Scenery& scenery_;
  const Mosaic& mosaic_;
  SpreadOutline outline_;
  std::vector<std::uint32_t> found_;
  std::vector<std::uint32_t> asked_;  ///< by slot: in which turn it was found last
  std::uint32_t turn_ = 0;
  glm::dvec2 open_at_{0};
};

}  // namespace frontmost::painter_detail
