// SPDX-License-Identifier: Apache-2.0
// What is not hidden of the strip beside a side is cut out, and the hem ends below that. Most sides of polygons that
// are painted late have nothing next to them that hides, and that is told without cutting anything.
//
// Around a corner in the middle of what is seen viewers blend all that meet there, and each takes its share of what is
// below. Only what covers all of the pixel leaves nothing of that. So the first that is painted goes around the corner:
// the hems of its two sides end at the same place.
#include "painter/traps/make_traps.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "base/pool.h"
#include "painter/traps/nearby_occluders.h"
#include "painter/traps/trap_profile.h"

namespace frontmost::painter_detail {
namespace {

constexpr std::size_t kPolygonsPerHemList = 1024;

/// Parts of the width to which a hem goes around a corner where it does not with all of it.
constexpr std::array kAround{1.0, 0.5, 0.25, 0.125};
/// How far a hem begins from a corner that it does not go around: in its height, and at most in the way to where that
/// changes.
constexpr double kInset = 0.5, kMostInset = 0.45;
/// Pixels by which what is hidden has to be wider than a hem: rims that lie on each other grow bold.
constexpr double kBeyondHem = 1;
/// Pixels: lower hems are none.
constexpr double kLeastHeight = 1.0 / 64;

/// Outwards from a way of unit length.
glm::dvec2 beside(const glm::dvec2& along) { return {-along.y, along.x}; }

/// The ways to a corner and from it, of unit length.
struct Bend {
  glm::dvec2 to{0}, from{0};

  /// Where the hems of both sides end: on the line that halves the angle outside. Blunt, as a mitre; sharp, it would
  /// be too far away, and both end on a line across.
  [[nodiscard]] glm::dvec2 end(double width) const {
    const double turned = glm::dot(to, from);
    if (turned >= 0) return (beside(to) + beside(from)) * (width / (1 + turned));
    const double cotangent = std::sqrt(std::max(1 + turned, 0.0) / (1 - turned));  // of half of what it turns by
    return (to - from) * (0.5 * width * (1 + cotangent));
  }
  [[nodiscard]] bool is_sharp() const { return glm::dot(to, from) < 0; }
};

/// A side of an outline, from its corner on, and the height of its hem.
struct Side {
  glm::dvec2 along{0};
  double length = 0;
  std::vector<TrapProfile::Knot> knots;
};

/// Not for several threads at once.
class TrapMaker {
 public:
  TrapMaker(const ScreenPolygons& screen, const Adjacency& adjacency, double width, const Execution& execution)
      : screen_(screen), nearby_(screen, adjacency, execution), width_(width) {}

  /// Adds the hems of the polygon in a slot, which has these corners.
  void add_hems(std::size_t slot, Outline given, HemList& list) {
    outline_ = screen_.outline(slot);
    // What reaches millions of pixels away has been cut, and has other sides.
    const auto is_same = [](const PaintCorner& a, const PaintCorner& b) {
      return glm::dvec2(a.at) == glm::dvec2(b.at);
    };
    if (screen_.hides(slot) && std::equal(outline_.begin(), outline_.end(), given.begin(), given.end(), is_same)) {
      nearby_.begin(slot, kReach * (width_ + kBeyondHem));
      set_sides();
      for (std::size_t i = 0; i < outline_.size(); ++i) fit(i);
      for (std::size_t i = 0; i < outline_.size(); ++i) around_[i] = reach_around(i);
      for (std::size_t i = 0; i < outline_.size(); ++i) add_hem(i, list);
    }
    list.ends.push_back(list.hems.size());
  }

 private:
  [[nodiscard]] std::size_t next(std::size_t i) const { return i + 1 == outline_.size() ? 0 : i + 1; }
  [[nodiscard]] std::size_t before(std::size_t i) const { return i == 0 ? outline_.size() - 1 : i - 1; }
  [[nodiscard]] glm::dvec2 corner(std::size_t i) const { return glm::dvec2(outline_[i].at); }
  [[nodiscard]] Bend bend(std::size_t i) const { return {sides_[before(i)].along, sides_[i].along}; }

  void set_sides() {
    sides_.resize(std::max(sides_.size(), outline_.size()));
    around_.resize(outline_.size());
    // Sides without a length have the way of the one before.
    for (std::size_t turn = 0, i = 0; turn < 2 * outline_.size(); ++turn, i = next(i)) {
      const glm::dvec2 way = corner(next(i)) - corner(i);
      sides_[i].length = glm::length(way);
      sides_[i].along = sides_[i].length < OutlineClipper::thin ? sides_[before(i)].along : way / sides_[i].length;
    }
  }

  /// Sets the height of a side's hem: as high as is hidden.
  void fit(std::size_t number) {
    Side& side = sides_[number];
    side.knots.clear();
    const glm::dvec2 from = corner(number), to = corner(next(number)), out = beside(side.along) * (width_ + kBeyondHem);
    // Few others are beside a part of a side.
    const int parts = int(std::clamp(side.length / (kStrip * width_), 1.0, kMostStrips));
    if (side.length < OutlineClipper::thin || nearby_.are_open_beside(number)) return;
    if (parts == 1 && !nearby_.hide_beside(from, to)) return;
    profile_.begin(from, side.along);
    for (int i = 0; i < parts; ++i) {
      const glm::dvec2 a = from + (to - from) * (double(i) / parts), b = from + (to - from) * (double(i + 1) / parts);
      profile_.add_open(nearby_.open_parts(outline_of({a, a + out, b + out, b})));
    }
    const std::vector<TrapProfile::Knot>& knots = profile_.fit(side.length, width_);
    const auto is_low = [](const TrapProfile::Knot& knot) { return knot.height < kLeastHeight; };
    if (!std::all_of(knots.begin(), knots.end(), is_low)) side.knots = knots;
  }

  /// How far the hems of both its sides go around a corner; 0: not at all.
  [[nodiscard]] double reach_around(std::size_t number) {
    const Side &to = sides_[before(number)], &from = sides_[number];
    if (to.knots.empty() || from.knots.empty()) return 0;
    const double height = std::min(to.knots.back().height, from.knots.front().height);
    const glm::dvec2 at = corner(number);
    const Bend turn = bend(number);
    for (const double part : kAround) {
      const double reach = part * width_, tested = part * (width_ + kBeyondHem);
      if (reach > height) continue;
      beside_ = {at, at + beside(turn.to) * tested};
      if (turn.is_sharp())
        beside_.insert(beside_.end(),
                       {at + (beside(turn.to) + turn.to) * tested, at + (beside(turn.from) - turn.from) * tested});
      else
        beside_.push_back(at + turn.end(tested));
      beside_.push_back(at + beside(turn.from) * tested);
      if (nearby_.open_parts(outline_of(beside_)).count() == 0) return reach;
    }
    return 0;
  }

  template <class Corners>
  [[nodiscard]] Outline outline_of(const Corners& corners) {
    asked_.clear();
    for (const glm::dvec2& at : corners) asked_.push_back({glm::dvec3(at, 1), true});
    return asked_;
  }
  [[nodiscard]] Outline outline_of(std::initializer_list<glm::dvec2> corners) {
    return outline_of<std::initializer_list<glm::dvec2>>(corners);
  }

  /// What ends at a corner ends before it: there its rim would run along what is open around the corner.
  static TrapProfile::Knot inset(const TrapProfile::Knot& end, const TrapProfile::Knot& beside) {
    const double way = beside.along - end.along, part = std::min(kInset * end.height / std::abs(way), kMostInset);
    return {end.along + part * way, end.height + part * (beside.height - end.height)};
  }

  void add_hem(std::size_t number, HemList& list) {
    const Side& side = sides_[number];
    if (side.knots.empty()) return;
    const std::size_t first = list.corners.size();
    const glm::dvec2 from = corner(number), to = corner(next(number)), out = beside(side.along);
    const auto add = [&](const glm::dvec2& at) { list.corners.push_back(at); };
    if (const double reach = around_[number]; reach > 0) {
      add(from + bend(number).end(reach));
      if (bend(number).is_sharp()) add(from + (out - side.along) * reach);
    }
    for (std::size_t i = 0; i < side.knots.size(); ++i) {
      const bool is_first = i == 0, is_last = i + 1 == side.knots.size();
      const double around = is_first ? around_[number] : is_last ? around_[next(number)] : 0;
      const double height = side.knots[i].height;
      // It lies on the side, or on the way around the corner.
      if ((is_first || is_last) && (height < kLeastHeight || height == around)) continue;
      const bool ends_here = (is_first || is_last) && around == 0;
      const TrapProfile::Knot knot = ends_here ? inset(side.knots[i], side.knots[is_first ? 1 : i - 1]) : side.knots[i];
      add(from + side.along * knot.along + out * knot.height);
    }
    if (const double reach = around_[next(number)]; reach > 0) {
      if (bend(next(number)).is_sharp()) add(to + (out + side.along) * reach);
      add(to + bend(next(number)).end(reach));
    }
    if (list.corners.size() > first)
      list.hems.push_back({std::uint32_t(number), std::uint32_t(list.corners.size() - first), first, from, to});
  }

  /// Widths of hems that a part of a side is long, of the longest which are in so many.
  static constexpr double kStrip = 8, kMostStrips = 256;
  /// How far from a polygon a hem of unit width may be.
  static constexpr double kReach = 1.5;

  const ScreenPolygons& screen_;
  NearbyOccluders nearby_;
  const double width_;
  TrapProfile profile_;
  Outline outline_;
  std::vector<Side> sides_;
  std::vector<double> around_;  ///< by corner: how far hems go around it
  std::vector<glm::dvec2> beside_;
  std::vector<PaintCorner> asked_;
};

/// By place what lists have by slot.
HemList assemble(const ScreenPolygons& screen, const std::vector<HemList>& lists) {
  HemList all;
  std::size_t hems = 0, corners = 0;
  for (const HemList& list : lists) {
    hems += list.hems.size();
    corners += list.corners.size();
  }
  all.hems.reserve(hems);
  all.corners.reserve(corners);
  all.ends.reserve(screen.count());
  for (std::uint32_t place = 0; place < screen.count(); ++place) {
    const std::size_t slot = screen.slot(place);
    const HemList& list = lists[slot / kPolygonsPerHemList];
    for (SideHem hem : list.of(slot % kPolygonsPerHemList)) {
      const std::span<const glm::dvec2> own = list.corners_of(hem);
      hem.first_corner = all.corners.size();
      all.corners.insert(all.corners.end(), own.begin(), own.end());
      all.hems.push_back(hem);
    }
    all.ends.push_back(all.hems.size());
  }
  return all;
}

}  // namespace

HemList side_hems(const PaintOrder& order, double width, const std::function<bool(PrimitiveId)>& hides,
                  const Execution& execution) {
  const ScreenPolygons screen(order, hides);
  const Adjacency adjacency(screen);
  const std::size_t count = screen.count();
  std::vector<HemList> lists((count + kPolygonsPerHemList - 1) / kPolygonsPerHemList);
  Pool<TrapMaker> hemmers;
  std::atomic<std::size_t> done{0};
  parallel_for(execution, count, kPolygonsPerHemList, [&](std::size_t begin, std::size_t end) {
    const auto hemmer =
        hemmers.borrow([&] { return std::make_unique<TrapMaker>(screen, adjacency, width, execution); });
    for (std::size_t slot = begin; slot < end; ++slot) {
      const PaintPolygon& polygon = order.polygons[screen.place(slot)];
      const Outline given(order.corners.data() + polygon.first_corner, polygon.corner_count);
      hemmer->add_hems(slot, given, lists[begin / kPolygonsPerHemList]);
    }
    report_progress(execution, "hems", double(done += end - begin) / double(count));
  });
  return assemble(screen, lists);
}

}  // namespace frontmost::painter_detail
