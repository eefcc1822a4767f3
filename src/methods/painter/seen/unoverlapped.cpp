// SPDX-License-Identifier: Apache-2.0
// The number of polygons over a point of the screen changes only at open sides, which have no adjacent polygon: at all
// others one polygon ends where the next begins. Meshes have few open sides. So the number is constant over a polygon
// that no open side crosses, and over its neighbours across sides on which no open side lies. If the number is 1,
// nothing overlaps these polygons.
//
//       ____________
//      /  /  /  /  /     A sheet over the background has open sides only at its rim. All polygons that no open side
//     /__/__/__/__/      crosses have the same number of polygons over them, and hand it on across their sides: one
//    /  /  /  /  /       look at the middle of one of them tells it for all. Nothing is handed on across a side if an
//   /__/__/__/__/        open side lies on its middle.
#include <algorithm>

#include "painter/limits.h"
#include "painter/seen/adjacency.h"

namespace frontmost::painter_detail {
namespace {

/// If a greater share of sides is open, the search takes longer than it saves.
constexpr double kMostOpen = 0.3;

/// The place of a way from a to b relative to an outline.
enum class Beside : std::uint8_t { apart, touching, crossing };

/// Separates by lines along the sides and the way: apart if one line keeps them more than OutlineClipper::thin away
/// from each other.
Beside beside(Outline outline, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 across = b - a;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  Beside found = Beside::crossing;
  const auto take = [&](double turn, const glm::dvec2& way) {
    if (turn < 0) return;
    const bool is_far = turn * turn > OutlineClipper::thin * OutlineClipper::thin * glm::dot(way, way);
    found = std::min(found, is_far ? Beside::apart : Beside::touching);
  };
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 p(outline[i].at), way = glm::dvec2(outline[i + 1 == outline.size() ? 0 : i + 1].at) - p;
    take(std::min(turn(way, a - p), turn(way, b - p)), way);
    const double corner = turn(across, p - a);
    least = std::min(least, corner);
    greatest = std::max(greatest, corner);
  }
  take(std::max(least, -greatest), across);
  return found;
}

bool is_near(const glm::dvec2& at, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 way = b - a, from = at - a;
  const double length = glm::dot(way, way);
  const double t = length > 0 ? std::clamp(glm::dot(from, way) / length, 0.0, 1.0) : 0;
  const glm::dvec2 aside = from - way * t;
  return glm::dot(aside, aside) <= OutlineClipper::thin * OutlineClipper::thin;
}

class Finder {
 public:
  Finder(const ScreenPolygons& screen, const Adjacency& adjacency, const std::vector<std::uint8_t>& gone,
         PaintEffort& effort)
      : screen_(screen),
        adjacency_(adjacency),
        gone_(gone),
        poll_(effort),
        state_(screen.count(), State::unknown),
        is_blocked_(screen.corners().size(), 0) {}

  [[nodiscard]] std::vector<std::uint8_t> find() {
    std::vector<std::uint8_t> alone(state_.size(), 0);
    if (!find_open_sides()) return alone;
    for (const OpenSide& side : open_) mark_near(side);
    for (std::uint32_t slot = 0; slot < state_.size(); ++slot)
      if (state_[slot] == State::unknown) spread_from(slot);
    for (std::size_t slot = 0; slot < alone.size(); ++slot) alone[slot] = state_[slot] == State::alone;
    return alone;
  }

 private:
  enum class State : std::uint8_t {
    unknown,
    crossed,  ///< by an open side, or by the border of the picture
    shared,
    alone,
  };
  struct OpenSide {
    glm::dvec2 from, to;
  };

  [[nodiscard]] bool is_there(std::size_t slot) const { return gone_.empty() || !gone_[slot]; }

  /// \returns false if there are too many.
  bool find_open_sides() {
    std::size_t sides = 0;
    for (std::size_t slot = 0; slot < screen_.count(); ++slot) {
      state_[slot] = is_there(slot) && is_in_picture(slot) ? State::unknown : State::crossed;
      if (!is_there(slot)) continue;
      const Outline outline = screen_.outline(slot);
      const std::size_t first = screen_.first_corner(slot);
      sides += outline.size();
      for (std::size_t i = 0; i < outline.size(); ++i) {
        const std::uint32_t across = adjacency_.across(first + i);
        if (across == no_index || !is_there(across))
          open_.push_back({glm::dvec2(outline[i].at), glm::dvec2(outline[i + 1 == outline.size() ? 0 : i + 1].at)});
      }
    }
    return double(open_.size()) <= kMostOpen * double(sides);
  }

  /// Whether the polygon lies in the picture: the grid's cells do not list open sides beyond.
  [[nodiscard]] bool is_in_picture(std::size_t slot) const {
    const Outline outline = screen_.outline(slot);
    return std::all_of(outline.begin(), outline.end(), [&](const PaintCorner& corner) {
      return corner.at.x >= 0 && corner.at.y >= 0 && corner.at.x <= screen_.size().x && corner.at.y <= screen_.size().y;
    });
  }

  void mark_near(const OpenSide& side) {
    const glm::dvec2 low = glm::min(side.from, side.to) - 2 * OutlineClipper::thin,
                     high = glm::max(side.from, side.to) + 2 * OutlineClipper::thin;
    const PieceGrid& grid = screen_.grid();
    const PieceGrid::Range all = grid.range({glm::vec2(low), glm::vec2(high), 0, 0});
    for (int y = all.first_y; y <= all.last_y; ++y) {
      const PieceGrid::Box row = grid.box(all.first_x, y);
      const auto [row_low, row_high] =
          part_of(side, row.low.y - 2 * OutlineClipper::thin, row.high.y + 2 * OutlineClipper::thin);
      const PieceGrid::Range cells = grid.range({{float(row_low), 0}, {float(row_high), 0}, 0, 0});
      for (int x = cells.first_x; x <= cells.last_x; ++x) mark_near(side, low, high, screen_.cell(x, y));
    }
  }

  /// The range in x of a side between two values of y, slightly widened.
  struct Interval {
    double low, high;
  };
  static Interval part_of(const OpenSide& side, double low, double high) {
    const glm::dvec2 way = side.to - side.from;
    const auto at = [&](double y) {
      const double t = way.y == 0 ? 0 : std::clamp((y - side.from.y) / way.y, 0.0, 1.0);
      return side.from.x + t * way.x;
    };
    if (way.y == 0)
      return {std::min(side.from.x, side.to.x) - 2 * OutlineClipper::thin,
              std::max(side.from.x, side.to.x) + 2 * OutlineClipper::thin};
    return {std::min(at(low), at(high)) - 2 * OutlineClipper::thin,
            std::max(at(low), at(high)) + 2 * OutlineClipper::thin};
  }

  void mark_near(const OpenSide& side, const glm::dvec2& low, const glm::dvec2& high,
                 std::span<const std::uint32_t> cell) {
    for (const std::uint32_t slot : cell) {
      poll_.count();
      if (state_[slot] != State::unknown) continue;
      const PolygonExtent& e = screen_.extent(slot);
      if (high.x < e.low.x || low.x > e.high.x || high.y < e.low.y || low.y > e.high.y) continue;
      const Beside found = beside(screen_.outline(slot), side.from, side.to);
      if (found == Beside::crossing) state_[slot] = State::crossed;
      if (found == Beside::touching) block(slot, side);
    }
  }

  /// Blocks the sides on whose middle an open side lies: nothing is known across them.
  void block(std::uint32_t slot, const OpenSide& side) {
    const Outline outline = screen_.outline(slot);
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const glm::dvec2 p(outline[i].at), q(outline[i + 1 == outline.size() ? 0 : i + 1].at);
      if (is_near(0.5 * (p + q), side.from, side.to)) is_blocked_[screen_.first_corner(slot) + i] = 1;
    }
  }

  void spread_from(std::uint32_t slot) {
    const Outline outline = screen_.outline(slot);
    glm::dvec2 middle(0);
    for (const PaintCorner& corner : outline) middle += glm::dvec2(corner.at) / double(outline.size());
    bool is_alone = true;
    for (const std::uint32_t other : screen_.cell_at(middle)) {
      poll_.count();
      if (other == slot || !is_there(other) || beside(screen_.outline(other), middle, middle) == Beside::apart)
        continue;
      // A neighbour that is only near proves nothing: the polygon is narrow here.
      if (is_within(screen_.outline(other), middle, 0)) return spread(slot, State::shared);
      is_alone = false;
    }
    if (is_alone) spread(slot, State::alone);
  }

  void spread(std::uint32_t first, State state) {
    state_[first] = state;
    found_.assign(1, first);
    while (!found_.empty()) {
      const std::uint32_t slot = found_.back();
      found_.pop_back();
      poll_.count();
      const std::size_t corner = screen_.first_corner(slot), count = screen_.outline(slot).size();
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t across = adjacency_.across(corner + i);
        if (is_blocked_[corner + i] || across == no_index || state_[across] != State::unknown) continue;
        state_[across] = state;
        found_.push_back(across);
      }
    }
  }

  const ScreenPolygons& screen_;
  const Adjacency& adjacency_;
  const std::vector<std::uint8_t>& gone_;
  Poll poll_;
  std::vector<State> state_;
  std::vector<std::uint8_t> is_blocked_;  ///< by corner
  std::vector<OpenSide> open_;
  std::vector<std::uint32_t> found_;
};

}  // namespace

std::vector<std::uint8_t> find_unoverlapped(const ScreenPolygons& screen, const Adjacency& adjacency,
                                            const std::vector<std::uint8_t>& gone, PaintEffort& effort) {
  return Finder(screen, adjacency, gone, effort).find();
}

}  // namespace frontmost::painter_detail
