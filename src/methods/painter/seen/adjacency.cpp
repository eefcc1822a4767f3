// SPDX-License-Identifier: Apache-2.0
// A side and its reverse have the same hash. Each side looks for its reverse in a table, and takes it out if it is
// there. Sides must be equal to the bit. This suffices, because polygons of a mesh got their corners from the same
// vertices by the same arithmetic.
//
//       ____________      The number of polygons over a point changes only at open sides, of which meshes have few. All
//      /  /  /  /  /      polygons that no open side crosses have the same number of polygons over them, and hand it
//     /__/__/__/__/       on across their sides: one look at the middle of one of them tells it for all.
#include "painter/seen/adjacency.h"

#include <algorithm>

#include "base/memory.h"

namespace frontmost::painter_detail {
namespace {

/// At most so many equal sides wait for a neighbour, and further ones count as open. Otherwise a stack of n equal
/// polygons would take n * n comparisons.
constexpr int kMostSame = 64;

/// Odd numbers without a pattern.
constexpr std::uint64_t kMixX = 0x9e3779b97f4a7c15, kMixY = 0xc2b2ae3d27d4eb4f, kMixSum = 0xd6e8feb86659fd93;

std::uint64_t hash_of(const glm::dvec3& at) {
  const std::uint64_t mixed = bits_as<std::uint64_t>(at.x) * kMixX + bits_as<std::uint64_t>(at.y) * kMixY;
  return mixed ^ (mixed >> 29);
}

/// A table of the sides that have no neighbour yet, in which a side and its reverse have the same place. A side is
/// removed once its neighbour comes. If meshes lie in the order of the screen, the table holds few sides at a time.
class OpenSides {
 public:
  OpenSides(const ScreenPolygons& screen, std::vector<std::uint32_t>& across) : screen_(screen), across_(across) {
    while (std::size_t(1) << bits_ < across.size() + across.size() / 4) ++bits_;
    entries_.assign(std::size_t(1) << bits_, {0, no_index});
  }

  /// Adds the side that begins at a corner of a slot's polygon.
  void add(std::uint32_t slot, std::uint32_t corner, std::uint64_t hash) {
    const auto tag = std::uint32_t((hash * kMixSum) >> 32);
    std::size_t i = home(tag);
    int same = 0;
    for (; entries_[i].corner != no_index; i = following(i)) {
      if (entries_[i].tag != tag) continue;
      if (!is_reverse(entries_[i].corner, slot, corner)) {
        if (++same < kMostSame) continue;
        alone_.push_back(corner);
        return;
      }
      // Before this swap, each side has its own slot across.
      std::swap(across_[entries_[i].corner], across_[corner]);
      return remove(i);
    }
    entries_[i] = {tag, corner};
  }
  /// Marks sides that still wait as having no neighbour.
  void finish() {
    for (const std::uint32_t corner : alone_) across_[corner] = no_index;
    for (const Entry& entry : entries_)
      if (entry.corner != no_index) across_[entry.corner] = no_index;
  }

 private:
  struct Entry {
    std::uint32_t tag, corner;
  };

  [[nodiscard]] std::size_t home(std::uint32_t tag) const { return std::size_t(tag) >> (32 - bits_); }
  [[nodiscard]] std::size_t following(std::size_t i) const { return i + 1 == entries_.size() ? 0 : i + 1; }

  /// Closes the gap, so that no search ends too early.
  void remove(std::size_t gap) {
    for (std::size_t i = following(gap); entries_[i].corner != no_index; i = following(i)) {
      const std::size_t mask = entries_.size() - 1, from_home = (i - home(entries_[i].tag)) & mask;
      if (from_home < ((i - gap) & mask)) continue;
      entries_[gap] = entries_[i];
      gap = i;
    }
    entries_[gap].corner = no_index;
  }

  [[nodiscard]] bool is_reverse(std::uint32_t a, std::uint32_t b_slot, std::uint32_t b) const {
    return at(a) == at(end_of(b_slot, b)) && at(end_of(across_[a], a)) == at(b);
  }
  [[nodiscard]] std::uint32_t end_of(std::uint32_t slot, std::uint32_t corner) const {
    const auto first = std::uint32_t(screen_.first_corner(slot));
    return corner + 1 == first + screen_.outline(slot).size() ? first : corner + 1;
  }
  [[nodiscard]] glm::dvec2 at(std::uint32_t corner) const { return glm::dvec2(screen_.corners()[corner].at); }

  const ScreenPolygons& screen_;
  std::vector<std::uint32_t>& across_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> alone_;  ///< sides that are not in the table
  unsigned bits_ = 1;
};

/// If a greater share of sides is open, the search takes longer than it saves.
constexpr double kMostOpen = 0.3;

/// The place of the segment from a to b relative to an outline.
enum class Beside : std::uint8_t { apart, touching, crossing };

/// Tests the lines through the sides of the outline, and the line through a and b. The result is `apart` if one of
/// these lines separates the outline from the segment a b, and one of the two is more than OutlineClipper::thin from
/// the line.
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

  /// Finds the open sides. \returns false if there are too many.
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

  /// Returns whether the polygon lies wholly in the picture. The grid's cells do not list open sides outside the
  /// picture.
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
    const auto at = [&](double y) { return side.from.x + std::clamp((y - side.from.y) / way.y, 0.0, 1.0) * way.x; };
    const double a = way.y == 0 ? side.from.x : at(low), b = way.y == 0 ? side.to.x : at(high);
    return {std::min(a, b) - 2 * OutlineClipper::thin, std::max(a, b) + 2 * OutlineClipper::thin};
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

  /// Blocks the sides whose middle lies on an open side, because nothing is known across them.
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
  std::vector<std::uint8_t> is_blocked_;  ///< by the corner at which a side begins
  std::vector<OpenSide> open_;
  std::vector<std::uint32_t> found_;
};

}  // namespace

Adjacency::Adjacency(const ScreenPolygons& screen) : across_(screen.corners().size()) {
  OpenSides open(screen, across_);
  for (std::uint32_t slot = 0; slot < screen.count(); ++slot) {
    const Outline outline = screen.outline(slot);
    if (outline.empty()) continue;
    const auto first = std::uint32_t(screen.first_corner(slot));
    for (std::uint32_t i = 0; i < outline.size(); ++i) across_[first + i] = slot;
    std::uint64_t hash_before = hash_of(outline.back().at);
    std::uint32_t before = first + std::uint32_t(outline.size()) - 1;
    for (std::uint32_t i = 0; i < outline.size(); before = first + i++) {
      const std::uint64_t hash = hash_of(outline[i].at);
      open.add(slot, before, hash_before + hash);
      hash_before = hash;
    }
  }
  open.finish();
}

std::vector<std::uint8_t> find_unoverlapped(const ScreenPolygons& screen, const Adjacency& adjacency,
                                            const std::vector<std::uint8_t>& gone, PaintEffort& effort) {
  return Finder(screen, adjacency, gone, effort).find();
}

}  // namespace frontmost::painter_detail
