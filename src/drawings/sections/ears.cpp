// SPDX-License-Identifier: Apache-2.0
// Holes are joined to the outer line by a bridge, a side that is there twice. Then ears are cut off until three corners
// are left; an ear is a corner whose neighbours see each other (G. Meisters. Polygons Have Ears. 1975).
//
//     +-----------------+                   +-----------------+         an ear at b: a, b, c turn left, and no other
//     |      +---+      |        ->         |------+---+      |         corner lies in the triangle that they make
//     |      +---+      |                   |      +---+      |
//     +-----------------+                   +-----------------+
//
// All turns are exact signs, so no ear overlaps another. Where outlines cross there may be no ear: then flat corners
// are cut, then any corner that turns left, then any corner.
#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "base/orientation.h"
#include "base/parallel.h"
#include "sections/regions.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t corners_per_poll = 1 << 10;
constexpr int most_cells = 1 << 10;  // along an axis

/// Corners in rings. The first ring is the outer line, to which the holes are joined.
struct Rings {
  explicit Rings(const Region& region) {
    add(region.outer);
    for (const SectionOutline& hole : region.holes) add(hole);
  }

  [[nodiscard]] std::size_t size() const { return links.size(); }
  [[nodiscard]] const glm::vec2& at(std::uint32_t i) const { return places[i]; }
  [[nodiscard]] std::uint32_t next(std::uint32_t i) const { return links[i].next; }
  [[nodiscard]] std::uint32_t last(std::uint32_t i) const { return links[i].last; }

  /// Appends the corners of the ring of `first`.
  void append_ring(std::uint32_t first, std::vector<std::uint32_t>& corners) const {
    std::uint32_t i = first;
    do corners.push_back(i);
    while ((i = next(i)) != first);
  }

  void remove(std::uint32_t i) {
    links[links[i].last].next = links[i].next;
    links[links[i].next].last = links[i].last;
  }

  /// Joins the rings of two corners that lie at one place, where a bridge would have no length.
  void splice(std::uint32_t a, std::uint32_t b) {
    std::swap(links[a].next, links[b].next);
    links[links[a].next].last = a;
    links[links[b].next].last = b;
  }

  /// Adds a side from corner a to b and back. Both corners are duplicated, with the copies at the end of the list.
  void bridge(std::uint32_t a, std::uint32_t b) {
    const auto a2 = std::uint32_t(size()), b2 = a2 + 1;
    places.push_back(places[a]);
    places.push_back(places[b]);
    links.push_back({b2, links[a].next});
    links.push_back({links[b].last, a2});
    links[links[a2].next].last = a2;
    links[links[b2].last].next = b2;
    links[a].next = b;
    links[b].last = a;
  }

  /// Whether a side from corner i to the point `to` leads into the polygon at i, and not along one of its sides.
  [[nodiscard]] bool runs_inside(std::uint32_t i, const glm::vec2& to) const {
    const glm::vec2 &before = at(last(i)), &here = at(i), &behind = at(next(i));
    const bool left_of_next = orientation(here, behind, to) > 0, right_of_last = orientation(here, before, to) < 0;
    return turn(i) > 0 ? left_of_next && right_of_last : left_of_next || right_of_last;
  }
  /// The orientation of the corner with its neighbours.
  [[nodiscard]] int turn(std::uint32_t i) const { return orientation(at(last(i)), at(i), at(next(i))); }

  void add(const SectionOutline& outline) {
    const auto first = std::uint32_t(size()), count = std::uint32_t(outline.size());
    firsts.push_back(first);
    for (std::uint32_t i = 0; i < count; ++i) {
      places.push_back(outline[i]);
      links.push_back({first + (i + count - 1) % count, first + (i + 1) % count});
    }
  }

  struct Link {
    std::uint32_t last, next;
  };

  std::vector<glm::vec2> places;
  std::vector<Link> links;  ///< the neighbours of each remaining corner
  std::vector<std::uint32_t> firsts;
};

/// Joins all holes to the outer line.
struct Joiner {
  void run() {
    std::vector<std::uint32_t> leftmost;
    for (std::size_t k = 1; k < rings.firsts.size(); ++k) leftmost.push_back(leftmost_of(rings.firsts[k]));
    // Holes are joined from left to right, so that each hole sees a part of the outer line or of a joined hole.
    std::sort(leftmost.begin(), leftmost.end(),
              [&](std::uint32_t a, std::uint32_t b) { return is_left_of(rings.at(a), rings.at(b)); });
    rings.append_ring(rings.firsts[0], joined);
    for (const std::uint32_t corner : leftmost) {
      check_cancelled(execution);
      const std::uint32_t other = nearest_in_sight(corner);
      rings.append_ring(corner, joined);
      if (other == no_index) continue;  // the outlines cross; the hole is filled as if it were not there
      if (rings.at(other) == rings.at(corner)) {
        rings.splice(other, corner);
        continue;
      }
      for (const std::size_t copy : {rings.size(), rings.size() + 1}) joined.push_back(std::uint32_t(copy));
      rings.bridge(other, corner);
    }
  }

  [[nodiscard]] std::uint32_t leftmost_of(std::uint32_t first) const {
    std::uint32_t best = first;
    for (std::uint32_t i = rings.next(first); i != first; i = rings.next(i))
      if (is_left_of(rings.at(i), rings.at(best))) best = i;
    return best;
  }

  [[nodiscard]] std::uint32_t nearest_in_sight(std::uint32_t corner) {
    const glm::vec2 from = rings.at(corner);
    const auto distance = [&](std::uint32_t i) {
      const glm::dvec2 off = glm::dvec2(rings.at(i)) - glm::dvec2(from);
      return glm::dot(off, off);
    };
    using Near = std::pair<double, std::uint32_t>;
    std::vector<Near> near;
    for (const std::uint32_t i : joined)
      if (!is_left_of(from, rings.at(i))) near.emplace_back(distance(i), i);
    // The nearest corner is nearly always in sight.
    std::priority_queue<Near, std::vector<Near>, std::greater<>> nearest(std::greater<>(), std::move(near));
    for (; !nearest.empty(); nearest.pop())
      if (sees(corner, nearest.top().second)) return nearest.top().second;
    return no_index;
  }

  [[nodiscard]] bool sees(std::uint32_t corner, std::uint32_t other) const {
    const glm::vec2 &a = rings.at(corner), &b = rings.at(other);
    if (!rings.runs_inside(other, a != b ? a : rings.at(rings.next(corner)))) return false;
    // The line of sight must not cross a side of an outline or of a bridge.
    for (std::uint32_t i = 0; i < rings.size(); ++i) {
      const glm::vec2 &p = rings.at(i), &q = rings.at(rings.next(i));
      if (p == a || q == a || p == b || q == b) continue;
      const int p_side = orientation(a, b, p), q_side = orientation(a, b, q);
      if (p_side * q_side > 0) continue;
      if (orientation(p, q, a) * orientation(p, q, b) > 0) continue;
      if (p_side == 0 && q_side == 0 && !overlap(a, b, p, q)) continue;
      return false;
    }
    return !has_place_between(a, b);
  }

  /// Whether two segments overlap. Precondition: both lie on one line.
  static bool overlap(const glm::vec2& a, const glm::vec2& b, const glm::vec2& p, const glm::vec2& q) {
    const auto [low, high] = is_left_of(a, b) ? std::pair(a, b) : std::pair(b, a);
    const auto [first, second] = is_left_of(p, q) ? std::pair(p, q) : std::pair(q, p);
    return is_left_of(first, high) && is_left_of(low, second);
  }

  [[nodiscard]] bool has_place_between(const glm::vec2& a, const glm::vec2& b) const {
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::vec2& p = rings.at(i);
      if (p != a && p != b && orientation(a, b, p) == 0 && is_left_of(a, p) != is_left_of(b, p)) return true;
    }
    return false;
  }

  Rings& rings;
  const Execution& execution;
  const std::size_t count = rings.size();  ///< number of corners without bridges
  std::vector<std::uint32_t> joined{};
};

/// Reflex corners in the cells of a grid: only these may lie in an ear.
class ReflexGrid {
 public:
  ReflexGrid(const Rings& rings, const std::vector<std::uint32_t>& corners) : low_(rings.at(corners[0])), high_(low_) {
    for (const std::uint32_t i : corners) {
      low_ = glm::min(low_, rings.at(i));
      high_ = glm::max(high_, rings.at(i));
    }
    std::vector<std::uint32_t> reflex;
    for (const std::uint32_t i : corners)
      if (rings.turn(i) <= 0) reflex.push_back(i);
    side_ = std::clamp(int(std::sqrt(double(reflex.size()))), 1, most_cells);
    cells_.resize(std::size_t(side_) * std::size_t(side_));
    for (const std::uint32_t i : reflex) {
      const glm::ivec2 cell = cell_of(rings.at(i));
      cells_[std::size_t(cell.y * side_ + cell.x)].push_back(i);
    }
  }

  /// Whether `test` holds for any corner that may lie in the box from `low` to `high`.
  template <class Test>
  [[nodiscard]] bool any(const glm::vec2& low, const glm::vec2& high, const Test& test) const {
    const glm::ivec2 first = cell_of(low), last = cell_of(high);
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x)
        for (const std::uint32_t i : cells_[std::size_t(y * side_ + x)])
          if (test(i)) return true;
    return false;
  }

 private:
  [[nodiscard]] glm::ivec2 cell_of(const glm::vec2& p) const {
    glm::ivec2 cell(0);
    for (int axis = 0; axis < 2; ++axis) {
      const double size = double(high_[axis]) - low_[axis];
      if (size > 0) cell[axis] = std::clamp(int((double(p[axis]) - low_[axis]) / size * side_), 0, side_ - 1);
    }
    return cell;
  }

  glm::vec2 low_, high_;
  int side_ = 1;
  std::vector<std::vector<std::uint32_t>> cells_;
};

struct EarCutter {
  void run(std::uint32_t corner, const Execution& execution) {
    std::size_t looked_at = 0, since_cut = 0;
    Patience patience = Patience::ears;
    while (left > 2) {
      if (++looked_at % corners_per_poll == 0) check_cancelled(execution);
      const std::uint32_t next = rings.next(corner);
      if (may_go(corner, patience)) {
        cut(corner);
        since_cut = 0;
        patience = Patience::ears;
        corner = rings.next(next);  // skips the next corner, whose triangle would be as narrow again
        while (is_cut[corner]) corner = rings.next(corner);
        continue;
      }
      corner = next;
      if (++since_cut < left) continue;
      patience = Patience(int(patience) + 1);
      since_cut = 0;
    }
  }

  /// The kind of corner that may be cut off. A later kind is used only if there is no corner of an earlier kind.
  enum class Patience : std::uint8_t { ears, flat, crossing, any };

  [[nodiscard]] bool may_go(std::uint32_t i, Patience patience) const {
    const int turn = rings.turn(i);
    if (turn > 0) return patience >= Patience::crossing || is_ear(i);
    return patience == Patience::any || (turn == 0 && patience >= Patience::flat);
  }

  [[nodiscard]] bool is_ear(std::uint32_t i) const {
    const glm::vec2 &a = rings.at(rings.last(i)), &b = rings.at(i), &c = rings.at(rings.next(i));
    const auto stands_in = [&](std::uint32_t k) {
      if (is_cut[k] || k == i || k == rings.last(i) || k == rings.next(i)) return false;
      const glm::vec2& p = rings.at(k);
      if (p == a || p == c) return false;
      // Another corner at the same place blocks the ear if one of its sides leads into the ear.
      if (p == b) return leads_into(i, rings.at(rings.last(k))) || leads_into(i, rings.at(rings.next(k)));
      return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
    };
    return !grid.any(glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), stands_in);
  }

  [[nodiscard]] bool leads_into(std::uint32_t ear, const glm::vec2& p) const {
    const glm::vec2 &a = rings.at(rings.last(ear)), &b = rings.at(ear), &c = rings.at(rings.next(ear));
    return orientation(a, b, p) > 0 && orientation(b, c, p) > 0;
  }

  /// Cuts an ear, and spikes that it leaves, which would hide the direction of the sides beside them.
  void cut(std::uint32_t i) {
    std::uint32_t ends[] = {rings.last(i), rings.next(i)};
    take(i);
    for (std::uint32_t& end : ends)
      while (left > 2 && !is_cut[end] && is_spike(end)) {
        const std::uint32_t before = rings.last(end);
        take(end);
        end = before;
      }
  }

  [[nodiscard]] bool is_spike(std::uint32_t i) const {
    const glm::vec2 &a = rings.at(rings.last(i)), &b = rings.at(i), &c = rings.at(rings.next(i));
    return a == b || b == c || (orientation(a, b, c) == 0 && is_left_of(a, b) == is_left_of(c, b));
  }

  void take(std::uint32_t i) {
    const glm::vec2 &a = rings.at(rings.last(i)), &b = rings.at(i), &c = rings.at(rings.next(i));
    if (a != b && b != c && c != a) triangles.push_back({a, b, c});
    rings.remove(i);
    is_cut[i] = 1;
    --left;
  }

  Rings& rings;
  const std::vector<std::uint32_t>& corners;
  std::vector<FlatTriangle>& triangles;
  const ReflexGrid grid{rings, corners};
  std::vector<std::uint8_t> is_cut = std::vector<std::uint8_t>(rings.size());
  std::size_t left = corners.size();
};

}  // namespace

void fill(const Region& region, std::vector<FlatTriangle>& triangles, const Execution& execution) {
  Rings rings(region);
  Joiner{rings, execution}.run();
  std::vector<std::uint32_t> corners;
  rings.append_ring(rings.firsts[0], corners);
  EarCutter{rings, corners, triangles}.run(corners[0], execution);
}

}  // namespace frontmost::lines_detail
