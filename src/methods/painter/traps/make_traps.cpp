// SPDX-License-Identifier: Apache-2.0
// Clipping finds the open parts of the strip beside a side, and the trap ends below them. Most sides of polygons that
// are painted late have no occluder next to them, which is found without any clipping.
//
// Around a corner in the middle of visible polygons, viewers blend all polygons that meet there, and the background
// keeps a share. Only a polygon that covers the whole pixel hides the background. So the polygon that is painted first
// goes around the corner: the traps of its two sides end at the same point.
#include <algorithm>
#include <array>

#include "painter/seen/slot_lists.h"
#include "painter/traps/nearby_occluders.h"
#include "painter/traps/trap_profile.h"

namespace frontmost::painter_detail {
namespace {

/// Shares of its width by which a trap goes around a corner; the first that fits is taken.
constexpr std::array kAround{1.0, 0.5, 0.25, 0.125};
/// Pixels by which the hidden strip must be wider than a trap: rims that lie on each other grow bold.
constexpr double kBeyondTrap = 1;
/// Length of a part of a side, in widths of its trap, and the most parts of a side.
constexpr double kStrip = 8, kMostStrips = 256;
/// The farthest that a trap of unit width may be from its polygon.
constexpr double kFarthest = 1.5;

/// A side of an outline, from its corner on, and the upper rim of its trap.
struct TrappedSide {
  glm::dvec2 along{0};
  double length = 0;
  std::vector<TrapKnot> knots;
};

/// Makes the traps of one polygon after another. Not for several threads at once.
class TrapMaker {
 public:
  TrapMaker(const ScreenPolygons& screen, const Adjacency& adjacency, double width, PaintEffort& effort)
      : screen_(screen), nearby_(screen, adjacency, effort), width_(width) {}

  /// Adds the traps of the polygon in a slot.
  void add_traps(std::size_t slot, TrapList& list) {
    outline_ = screen_.outline(slot);
    if (screen_.is_occluder(slot)) {
      nearby_.begin(slot, kFarthest * (width_ + kBeyondTrap));
      set_sides();
      for (std::size_t i = 0; i < outline_.size(); ++i) fit(i);
      for (std::size_t i = 0; i < outline_.size(); ++i) around_[i] = reach_around(i);
      for (std::size_t i = 0; i < outline_.size(); ++i) add_trap(i, list);
    }
    list.ends.push_back(list.traps.size());
  }

 private:
  [[nodiscard]] std::size_t next(std::size_t i) const { return i + 1 == outline_.size() ? 0 : i + 1; }
  [[nodiscard]] std::size_t before(std::size_t i) const { return i == 0 ? outline_.size() - 1 : i - 1; }
  [[nodiscard]] glm::dvec2 corner(std::size_t i) const { return glm::dvec2(outline_[i].at); }

  void set_sides() {
    sides_.resize(std::max(sides_.size(), outline_.size()));
    around_.resize(outline_.size());
    // Sides without a length take the direction of the side before.
    for (std::size_t turn = 0, i = 0; turn < 2 * outline_.size(); ++turn, i = next(i)) {
      const glm::dvec2 way = corner(next(i)) - corner(i);
      sides_[i].length = glm::length(way);
      sides_[i].along = sides_[i].length < OutlineClipper::thin ? sides_[before(i)].along : way / sides_[i].length;
    }
  }

  /// Sets the height of a side's trap: as high as is hidden.
  void fit(std::size_t number) {
    TrappedSide& side = sides_[number];
    side.knots.clear();
    const glm::dvec2 from = corner(number), to = corner(next(number)),
                     out = outwards(side.along) * (width_ + kBeyondTrap);
    // Few other polygons are beside a part of a side.
    const int parts = int(std::clamp(side.length / (kStrip * width_), 1.0, kMostStrips));
    if (side.length < OutlineClipper::thin || nearby_.are_open_beside(number)) return;
    if (parts == 1 && !nearby_.hide_beside(from, to)) return;
    profile_.begin(from, side.along);
    for (int i = 0; i < parts; ++i) {
      const glm::dvec2 a = from + (to - from) * (double(i) / parts), b = from + (to - from) * (double(i + 1) / parts);
      profile_.add_open(nearby_.open_parts(outline_of({a, a + out, b + out, b})));
    }
    const std::vector<TrapKnot>& knots = profile_.fit(side.length, width_);
    const auto is_low = [](const TrapKnot& knot) { return knot.height < least_trap_height; };
    if (!std::all_of(knots.begin(), knots.end(), is_low)) side.knots = knots;
  }

  /// How far the traps of both sides of a corner go around it; 0: not at all.
  [[nodiscard]] double reach_around(std::size_t number) {
    const TrappedSide &to = sides_[before(number)], &from = sides_[number];
    if (to.knots.empty() || from.knots.empty()) return 0;
    const double height = std::min(to.knots.back().height, from.knots.front().height);
    const glm::dvec2 at = corner(number);
    const TrapCorner bend{to.along, from.along};
    for (const double part : kAround) {
      const double reach = part * width_, tested = part * (width_ + kBeyondTrap);
      if (reach > height) continue;
      beside_ = {at, at + outwards(bend.to) * tested};
      if (bend.is_sharp())
        beside_.insert(beside_.end(),
                       {at + (outwards(bend.to) + bend.to) * tested, at + (outwards(bend.from) - bend.from) * tested});
      else
        beside_.push_back(at + bend.meeting_point(tested));
      beside_.push_back(at + outwards(bend.from) * tested);
      if (nearby_.open_parts(outline_of(beside_)).count() == 0) return reach;
    }
    return 0;
  }

  [[nodiscard]] Outline outline_of(std::span<const glm::dvec2> corners) {
    asked_.clear();
    for (const glm::dvec2& at : corners) asked_.push_back({glm::dvec3(at, 1), true});
    return asked_;
  }
  [[nodiscard]] Outline outline_of(const std::array<glm::dvec2, 4>& corners) {
    return outline_of(std::span<const glm::dvec2>(corners));
  }

  void add_trap(std::size_t number, TrapList& list) const {
    const TrappedSide& side = sides_[number];
    if (side.knots.empty()) return;
    const std::size_t after = next(number);
    list.traps.push_back({std::uint32_t(list.ends.size()),
                          std::uint32_t(number),
                          std::uint32_t(side.knots.size()),
                          list.knots.size(),
                          corner(number),
                          corner(after),
                          {around_[number], sides_[before(number)].along},
                          {around_[after], sides_[after].along}});
    list.knots.insert(list.knots.end(), side.knots.begin(), side.knots.end());
  }

  const ScreenPolygons& screen_;
  NearbyOccluders nearby_;
  const double width_;
  TrapProfile profile_;
  Outline outline_;
  std::vector<TrappedSide> sides_;
  std::vector<double> around_;  ///< by corner: reach of traps around it
  std::vector<glm::dvec2> beside_;
  std::vector<PaintCorner> asked_;
};

}  // namespace

TrapList make_traps(std::span<const ScreenPolygon> polygons, const View& view, double width,
                    const Execution& execution) {
  const ScreenPolygons screen(polygons, view);
  const Adjacency adjacency(screen);
  PaintEffort effort(execution, screen.count());
  return list_by_place<TrapList>(
      screen, execution, "traps", [&] { return std::make_unique<TrapMaker>(screen, adjacency, width, effort); },
      [](TrapMaker& maker, std::size_t slot, TrapList& list) { maker.add_traps(slot, list); });
}

}  // namespace frontmost::painter_detail
