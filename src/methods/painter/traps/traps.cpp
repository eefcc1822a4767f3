// SPDX-License-Identifier: Apache-2.0
// Traps for polygons in the order of painting, as high as later polygons hide them. Clipping the strip beside a side by
// the occluders around the polygon leaves the open parts of the strip, and the trap ends below them. Most sides of
// polygons that are painted late have no occluder beside them, and are not clipped at all.
//
// Around a corner in the middle of visible polygons, viewers blend all polygons that meet there, and the background
// keeps a share. Only a polygon that covers the whole pixel hides the background. So the polygon that is painted first
// goes around the corner: the traps of its two sides end at the same point.
#include "painter/traps/traps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "painter/limits.h"
#include "painter/seen/adjacency.h"

namespace frontmost::painter_detail {
namespace {

/// A strip that does not go around a corner begins at a distance from it: kInset times the strip's height, but at most
/// the share kMostInset of the way to the next knot.
constexpr double kInset = 0.5, kMostInset = 0.45;

/// In pixels. A part of a side ends where the whole side ends if their ends are this close, because both may have been
/// rounded.
constexpr double kAtEnd = 1.0 / 1024;

bool is_at(const glm::dvec2& a, const glm::dvec2& b) { return glm::length(a - b) <= kAtEnd; }

/// Returns the knot at which a strip ends before a corner. If the strip ended at the corner, its rim would run along
/// open places around the corner.
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
    // A knot on the side, or on the way around the corner, is left out.
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

/// The cutting line goes through `at`, perpendicular to the side. Removes the corners with number `first` and above
/// that lie before the line, and adds the point where the rim of the strip, which starts at `end`, crosses the line.
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

/// Writes the corners of a strip beside the part of its side that goes from `from` to `to`.
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

/// A polygon in more cells of the grid may have thousands of others around it: each outline then has a list of its own.
constexpr int kMostCells = 64;
/// The most later polygons of a cell, from the front-most on, that are tried as covers of a polygon's surroundings.
/// Without a limit, a stack of n planes would take n * n steps. A trap that the first 4,096 do not hide is not made.
constexpr std::size_t kMostHiders = 4096;

/// Returns whether an outline lies next to the outer side of a way, and has points more than OutlineClipper::thin away
/// from it.
bool is_beside(Outline outline, const glm::dvec2& from, const glm::dvec2& way) {
  const double length = glm::length(way), thin = OutlineClipper::thin * length;
  double near = std::numeric_limits<double>::infinity(), far = -near, first = near, last = -near;
  for (const PaintCorner& corner : outline) {
    const glm::dvec2 at = glm::dvec2(corner.at) - from;
    const double out = way.x * at.y - way.y * at.x, along = glm::dot(way, at);
    near = std::min(near, out);
    far = std::max(far, out);
    first = std::min(first, along);
    last = std::max(last, along);
  }
  return near <= thin && far > thin && first < length * length && last > 0;
}

/// Finds the occluders around one polygon after another. A trap is hidden by occluders that are painted after the
/// polygon, and by occluders of the polygon's own group wherever they are in the order, because they look the same. The
/// occluders around a polygon are listed when a question first needs them, once for all questions about it, and most
/// polygons have few. Not for several threads at once.
class NearbyOccluders {
 public:
  NearbyOccluders(const ScreenPolygons& screen, const Adjacency& adjacency, PaintEffort& effort)
      : screen_(screen), adjacency_(adjacency), poll_(effort), listed_(screen.count(), 0) {}

  /// Selects the polygon in a slot, and occluders up to `reach` pixels around it.
  void begin(std::size_t slot, double reach) {
    slot_ = slot;
    around_ = box_of(screen_.outline(slot));
    around_.low -= float(reach);
    around_.high += float(reach);
    is_listed_ = false;
  }
  /// Returns whether this side is shared with another polygon that has an area and hides nothing beyond the side.
  [[nodiscard]] bool are_open_beside(std::size_t side) const {
    const std::uint32_t across = across_of(side);
    if (across == no_index) return false;
    // If the polygon across has no area, other polygons begin beyond it.
    return across == slot_ || (!may_hide(across) && !is_flat(screen_.outline(across)));
  }
  /// Returns whether anything hides points next to a side of the polygon, on its outer side.
  [[nodiscard]] bool hide_beside(std::size_t side, const glm::dvec2& from, const glm::dvec2& to) {
    const std::uint32_t across = across_of(side);
    if (across != no_index && may_hide(across) && is_beside(screen_.outline(across), from, to - from)) return true;
    PolygonExtent box{glm::min(glm::vec2(from), glm::vec2(to)), glm::max(glm::vec2(from), glm::vec2(to)), 0, 0};
    box.low -= float(2 * OutlineClipper::thin);
    box.high += float(2 * OutlineClipper::thin);
    return any_of(box, [&](const Hider& hider) { return is_beside(screen_.outline(hider.slot), from, to - from); });
  }
  /// Returns the parts of a convex outline within reach that are not hidden; valid until the next call.
  [[nodiscard]] const OutlineClipper& open_parts(Outline outline) {
    cutter_.begin(outline);
    any_of(box_of(outline), [&](const Hider& hider) {
      const Cover cover{screen_.outline(hider.slot), glm::dvec2(hider.low), glm::dvec2(hider.high)};
      poll_.count(cutter_.count());
      return cutter_.subtract(cover);
    });
    return cutter_;
  }

 private:
  struct Hider {
    glm::vec2 low, high;  ///< the box around its outline, in pixels
    std::uint32_t slot;
  };
  /// Returns the slot of the polygon across a side, or no_index.
  [[nodiscard]] std::uint32_t across_of(std::size_t side) const {
    return adjacency_.across(screen_.first_corner(slot_) + side);
  }
  [[nodiscard]] bool may_hide(std::uint32_t other) const {
    return other != slot_ && screen_.place(other) >= screen_.first_place(slot_) && screen_.is_occluder(other);
  }
  /// Sets hiders_ to occluders whose boxes overlap `box`.
  void list(const PolygonExtent& box) {
    if (++turn_ == 0) {
      std::fill(listed_.begin(), listed_.end(), 0);
      turn_ = 1;
    }
    hiders_.clear();
    const std::uint32_t first_place = screen_.first_place(slot_);
    const PieceGrid::Range cells = screen_.grid().range(box);
    for (int y = cells.first.y; y <= cells.last.y; ++y)
      for (int x = cells.first.x; x <= cells.last.x; ++x) {
        const std::span<const std::uint32_t> cell = screen_.cell(x, y);
        std::size_t count = 0;
        for (std::size_t i = cell.size(); i-- > 0 && count < kMostHiders && screen_.place(cell[i]) >= first_place;) {
          const std::uint32_t other = cell[i];
          if (listed_[other] == turn_) continue;
          listed_[other] = turn_;
          poll_.count();
          const PolygonExtent& e = screen_.extent(other);
          if (other == slot_ || is_apart(e, box) || !screen_.is_occluder(other)) continue;
          hiders_.push_back({e.low, e.high, other});
          ++count;
        }
      }
  }
  /// Calls visit(hider) for occluders whose boxes overlap `box`, until it returns true. \returns whether it did.
  template <class Visit>
  bool any_of(const PolygonExtent& box, const Visit& visit) {
    if (!is_listed_) {
      is_listed_ = screen_.grid().range(around_).count() <= kMostCells;
      list(is_listed_ ? around_ : box);
    }
    return std::any_of(hiders_.begin(), hiders_.end(), [&](const Hider& hider) {
      if (is_apart(hider, box)) return false;
      poll_.count();
      return visit(hider);
    });
  }

  const ScreenPolygons& screen_;
  const Adjacency& adjacency_;
  Poll poll_;
  OutlineClipper cutter_;
  std::size_t slot_ = 0;
  PolygonExtent around_{};  ///< the box around the polygon and everything within reach
  bool is_listed_ = false;  ///< hiders_ holds all occluders in around_
  std::vector<Hider> hiders_;
  std::vector<std::uint32_t> listed_;  ///< by slot: the turn in which it was listed last
  std::uint32_t turn_ = 0;
};

/// Heights change by at most this much for every pixel along a side.
constexpr double kSteepest = 1;
/// A trap ends this many pixels below open parts above it, or by this share of the way to them if that is less.
constexpr double kProfileMargin = 1, kProfileMarginPart = 0.6;
/// The least area that a knot must gain, relative to the square of the greatest height.
constexpr double kLeastGain = 1.0 / 16;

/// Heights of a trap above a side, linear between knots. Not for several threads at once.
class TrapProfile {
 public:
  /// Begins a side at `from` with the direction `way`, of unit length.
  void begin(const glm::dvec2& from, const glm::dvec2& way) {
    from_ = from;
    way_ = way;
    rims_.clear();
  }
  /// Adds parts beside the side that are not hidden.
  void add_open(const OutlineClipper& open) {
    for (std::size_t i = 0; i < open.count(); ++i) {
      glm::dvec2 before = placed(open[i].back());
      for (const PaintCorner& corner : open[i]) {
        const glm::dvec2 at = placed(corner);
        rims_.push_back({before, at});
        before = at;
      }
    }
  }
  /// Returns the height that is hidden along the side, at most `most`, reduced at open parts and near them. So no rim
  /// of a trap runs along an outline: viewers would blend both, and the outline would grow bold.
  [[nodiscard]] const std::vector<TrapKnot>& fit(double length, double most) {
    place_knots(length, most);
    knots_.clear();
    for (const double along : places_) knots_.push_back({along, height_at(along, most)});
    leave_out(kLeastGain * most * most);
    return knots_;
  }

 private:
  /// A side of an open part, between two points (along the side of the polygon, above it).
  struct Rim {
    glm::dvec2 from, to;
  };
  [[nodiscard]] glm::dvec2 placed(const PaintCorner& corner) const {
    const glm::dvec2 at = glm::dvec2(corner.at) - from_;
    const double height = std::max(0.0, way_.x * at.y - way_.y * at.x);
    return {glm::dot(way_, at), height - std::min(kProfileMargin, kProfileMarginPart * height)};
  }
  [[nodiscard]] double height_at(double along, double most) const {
    double least = most;
    for (const Rim& rim : rims_) {
      const glm::dvec2 &a = rim.from, &b = rim.to;
      least = std::min(least, b.y + kSteepest * std::abs(along - b.x));
      if ((a.x < along) == (b.x < along)) continue;
      least = std::min(least, a.y + (b.y - a.y) * ((along - a.x) / (b.x - a.x)));
    }
    return std::max(least, 0.0);
  }
  /// Places knots where the height can change: at the corners of open parts, where the steepest lines from them reach
  /// the full height, and where sides of open parts do. Between knots the height is nowhere below the straight line.
  void place_knots(double length, double most) {
    places_.assign({0, length});
    const auto add = [&](double along) {
      if (along > 0 && along < length) places_.push_back(along);
    };
    for (const auto& [a, b] : rims_) {
      if (b.y < most) {
        add(b.x);
        add(b.x - (most - b.y) / kSteepest);
        add(b.x + (most - b.y) / kSteepest);
      }
      if ((a.y < most) != (b.y < most)) add(a.x + (b.x - a.x) * ((most - a.y) / (b.y - a.y)));
    }
    std::sort(places_.begin(), places_.end());
    const auto is_same = [](double a, double b) { return b - a < OutlineClipper::thin; };
    places_.erase(std::unique(places_.begin(), places_.end() - 1, is_same), places_.end() - 1);
  }
  /// Leaves out knots, those of the least gain first, because every knot is two numbers in the file. A knot stays if
  /// the line past it would be higher anywhere.
  void leave_out(double least_gain) {
    while (knots_.size() > 2) {
      std::size_t best = 0;
      double least = least_gain;
      for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
        const TrapKnot &a = knots_[i - 1], &b = knots_[i], &c = knots_[i + 1];
        const double part = (b.along - a.along) / (c.along - a.along);
        const double above = b.height - (a.height + (c.height - a.height) * part);
        const double gain = 0.5 * above * (c.along - a.along);
        if (above < -1e-9 || gain >= least) continue;
        least = gain;
        best = i;
      }
      if (best == 0) return;
      knots_.erase(knots_.begin() + std::ptrdiff_t(best));
    }
  }

  glm::dvec2 from_{0}, way_{0};
  std::vector<Rim> rims_;
  std::vector<double> places_;
  std::vector<TrapKnot> knots_;
};

/// Shares of the trap's width by which it may go around a corner; the first share that fits is taken.
constexpr std::array kAround{1.0, 0.5, 0.25, 0.125};
/// Pixels by which the hidden strip must be wider than a trap, because rims that lie on each other grow bold.
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

  /// Sets the knots of a side's trap. Along the side, the trap is as high as the strip that other polygons hide there,
  /// but no higher than `width_`.
  void fit(std::size_t number) {
    TrappedSide& side = sides_[number];
    side.knots.clear();
    const glm::dvec2 from = corner(number), to = corner(next(number)),
                     out = outwards(side.along) * (width_ + kBeyondTrap);
    // A long side is divided, because few other polygons are beside a part of it.
    const int parts = int(std::clamp(side.length / (kStrip * width_), 1.0, kMostStrips));
    if (side.length < OutlineClipper::thin || nearby_.are_open_beside(number)) return;
    if (parts == 1 && !nearby_.hide_beside(number, from, to)) return;
    profile_.begin(from, side.along);
    for (int i = 0; i < parts; ++i) {
      const glm::dvec2 a = from + (to - from) * (double(i) / parts), b = from + (to - from) * (double(i + 1) / parts);
      beside_ = {a, a + out, b + out, b};
      profile_.add_open(open_parts());
    }
    const std::vector<TrapKnot>& knots = profile_.fit(side.length, width_);
    const auto is_low = [](const TrapKnot& knot) { return knot.height < least_trap_height; };
    if (!std::all_of(knots.begin(), knots.end(), is_low)) side.knots = knots;
  }

  /// Returns how many pixels the traps of both sides of a corner go around it, or 0 if they do not.
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
      if (open_parts().count() == 0) return reach;
    }
    return 0;
  }

  /// Returns the parts of the outline in beside_ that are not hidden.
  [[nodiscard]] const OutlineClipper& open_parts() {
    asked_.clear();
    for (const glm::dvec2& at : beside_) asked_.push_back({glm::dvec3(at, 1), true});
    return nearby_.open_parts(asked_);
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

void write_outline(const TrapList& list, std::span<const TrappedCorner> outline, std::vector<glm::dvec2>& corners) {
  const Trap* before = nullptr;  // the trap that ends at the corner
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 &from = outline[i].at, &to = outline[i + 1 == outline.size() ? 0 : i + 1].at;
    const Trap* const trap = outline[i].trap == no_trap ? nullptr : &list.traps[outline[i].trap];
    corners.push_back(from);
    const std::size_t end = corners.size();
    if (trap) write_trap(list, *trap, from, to, corners);
    const bool is_written = corners.size() > end;
    // Both strips go around the corner, which lies within them: the end of the first is the beginning of the second.
    if (is_written && before && trap->at_from.reach > 0 && before->polygon == trap->polygon && is_at(from, trap->from))
      corners.erase(corners.begin() + std::ptrdiff_t(end) - 1, corners.begin() + std::ptrdiff_t(end) + 1);
    before = is_written ? trap : nullptr;
  }
}

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
