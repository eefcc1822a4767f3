// SPDX-License-Identifier: Apache-2.0
// Newell's sort with exchanges, changed so that it always ends. A piece P is painted once everything that it covers is
// painted; covered pieces that are not painted yet go first. This is a depth-first search: if it comes back to a
// waiting piece, all pieces in between have no order (Tarjan's strongly connected components). Pieces come from far to
// near, so almost everything that a piece covers is painted already. Neighbours are looked for when a piece's turn
// comes, so no pair is ever stored. The search has its own stack, because chains of covering pieces may be as long as
// there are pieces.
//
//    far                                         near
//    [painted ......][ P waits -> Q waits -> R ][ not found yet ...]
//                         ^                |
//                         +---- covers ----+       R covers P, which is waiting: P, Q and R have no order
#include <algorithm>
#include <optional>
#include <unordered_map>

#include "base/memory.h"
#include "painter/order/piece_grid.h"
#include "painter/stages.h"
#include "surfaces/radix_sort.h"

namespace frontmost::painter_detail {
namespace {

/// Returns an integer that is greater for lesser depths.
std::uint32_t falling_key(float depth) {
  const auto bits = bits_as<std::uint32_t>(depth + 0.0f);  // no -0
  return bits >> 31 ? bits : ~bits & 0x7fffffff;
}

/// Sorts by a depth of each piece, the greatest first; equal depths by id, the greatest first, then by number. Bits of
/// depths are turned into integers, so a radix sort of (depth, piece) needs no comparison. Runs of equal depths are
/// short in most scenes.
template <class Depth>
void sort_by_depth(const Pieces& pieces, std::vector<std::uint32_t>& members, const Depth& depth,
                   const Execution& execution) {
  constexpr std::size_t few = 2048;  // counting digits does not pay for fewer pieces
  Buffer<std::uint64_t> items(members.size());
  for (std::size_t i = 0; i < items.size(); ++i)
    items[i] = std::uint64_t(falling_key(depth(members[i]))) << 32 | members[i];
  if (items.size() < few) {
    std::sort(items.begin(), items.end());
  } else {
    items = radix_sort(std::move(items), 32, execution);
  }
  const auto is_before = [&](std::uint64_t a, std::uint64_t b) {
    const PrimitiveId id_a = pieces.face(std::uint32_t(a)).id, id_b = pieces.face(std::uint32_t(b)).id;
    return id_a != id_b ? id_a > id_b : std::uint32_t(a) < std::uint32_t(b);
  };
  for (std::size_t begin = 0, end; begin < items.size(); begin = end) {
    for (end = begin + 1; end < items.size() && items[end] >> 32 == items[begin] >> 32;) ++end;
    if (end > begin + 1) std::sort(items.begin() + begin, items.begin() + end, is_before);
  }
  for (std::size_t i = 0; i < items.size(); ++i) members[i] = std::uint32_t(items[i]);
}

/// Tests whether piece P covers piece Q. The tests go from the cheapest to the most expensive, and the first test that
/// decides ends them:
///
///    1. P lies wholly behind the plane of Q:        P does not cover Q
///    2. Q lies wholly in front of the plane of P:   P does not cover Q
///    3. a side separates P from Q on the screen:    P does not cover Q
///    4. P and Q are whole triangles:                vertices in the overlap tell which is nearer, or sides that cross
///
/// The first two tests decide most pairs. The fourth test reuses the signs of the third, so no sign is computed twice.
/// All signs are exact, so a pair that is tested in two cells, or also with P and Q exchanged, gets consistent answers.
class NewellTests {
 public:
  NewellTests(const Pieces& pieces, std::uint32_t piece)
      : pieces_(pieces), piece_(piece), face_(pieces.face(piece)), plane_(face_.plane()) {}

  [[nodiscard]] const Plane& plane() const { return plane_; }
  /// Returns whether the piece covers a point of `other`, by all tests except those of the extents. Also true if one of
  /// the two was cut and no test decides, because they may then have no order.
  [[nodiscard]] bool covers(std::uint32_t other, PaintSteps& steps) {
    const Face& face = pieces_.face(other);
    const Plane other_plane = face.plane();
    bool is_flat = false;
    if (pieces_.keeps_off(piece_, other_plane, 1, is_flat) && !is_flat) {
      ++steps.behind;
      return false;
    }
    if (!is_flat && pieces_.keeps_off(other, plane_, -1, is_flat)) {
      ++steps.before;
      return false;
    }
    if (is_apart(other)) {
      ++steps.projections_apart;
      return false;
    }
    ++steps.compared;
    if (is_flat) return face_.id < face.id;
    if (pieces_.keeps_off(other, plane_, 1, is_flat) || pieces_.keeps_off(piece_, other_plane, -1, is_flat))
      return true;
    if (!pieces_.is_whole(piece_) || !pieces_.is_whole(other)) return true;
    return is_over(face, other_plane);
  }

 private:
  /// turns[k][i]: the side of edge k of one triangle on which vertex i of the other triangle lies.
  using Turns = std::array<std::array<int, 3>, 3>;
  static bool is_within(const Turns& turns, std::size_t corner) {
    return turns[0][corner] >= 0 && turns[1][corner] >= 0 && turns[2][corner] >= 0;
  }

  /// Convex polygons are apart if and only if an edge of either separates them. For pieces that were cut, only the
  /// edges of their triangles are tested.
  [[nodiscard]] bool is_apart(std::uint32_t other) {
    if (!edges_) edges_.emplace(edges_of(face_));
    if (is_outside(*edges_, other, other_turns_)) return true;
    return is_outside(edges_of(pieces_.face(other)), piece_, turns_);
  }
  [[nodiscard]] bool is_outside(const std::array<Plane, 3>& edges, std::uint32_t piece, Turns& turns) const {
    const Face& face = pieces_.face(piece);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) turns[k][i] = edges[k].side(glm::dvec3(face.corners[i]));
      if (turns[k][0] <= 0 && turns[k][1] <= 0 && turns[k][2] <= 0) return true;
      bool is_flat = false;
      if (face.shape != no_index && pieces_.keeps_off(piece, edges[k], 1, is_flat)) return true;
    }
    return false;
  }
  /// Returns whether this triangle is nearer anywhere in the overlap on the screen. Which triangle is nearer changes
  /// only along a line, so the corners of the overlap tell.
  [[nodiscard]] bool is_over(const Face& other, const Plane& other_plane) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (is_within(turns_, i) && other_plane.side(glm::dvec3(face_.corners[i])) > 0) return true;
      if (is_within(other_turns_, i) && plane_.side(glm::dvec3(other.corners[i])) < 0) return true;
    }
    return crosses_over(other);
  }
  /// Returns whether an edge of this triangle passes in front of an edge of the other.
  [[nodiscard]] bool crosses_over(const Face& other) const {
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next_k = (k + 1) % 3, next_i = (i + 1) % 3;
        if (other_turns_[k][i] * other_turns_[k][next_i] >= 0 || turns_[i][k] * turns_[i][next_k] >= 0) continue;
        const glm::dvec3 from(face_.corners[k]), to(face_.corners[next_k]);
        const glm::dvec3 other_from(other.corners[i]), other_to(other.corners[next_i]);
        const int order = sign_of_determinant({to, from}, {other_from, from}, {other_to, from});
        if (order * other_turns_[k][i] < 0) return true;
      }
    return false;
  }
  [[nodiscard]] std::array<Plane, 3> edges_of(const Face& face) const {
    return {pieces_.edge_plane(face, 0), pieces_.edge_plane(face, 1), pieces_.edge_plane(face, 2)};
  }

  const Pieces& pieces_;
  const std::uint32_t piece_;
  const Face& face_;
  const Plane plane_;
  std::optional<std::array<Plane, 3>> edges_;  ///< made when first needed
  Turns other_turns_{}, turns_{};              ///< turns of the other's vertices about this piece's edges, and the
                                               ///< reverse
};

constexpr std::uint32_t kReportEvery = 1 << 14;
/// Cells with more pieces have boxes around many pieces at a time.
constexpr std::size_t kManyPieces = 256;

class Search {
 public:
  /// `members` are sorted from far to near.
  Search(const Pieces& pieces, const std::vector<std::uint32_t>& members, PaintSteps& steps, Poll& poll)
      : pieces_(pieces),
        members_(members),
        extents_(extents_of(pieces, members)),
        grid_(extents_),
        steps_(steps),
        poll_(poll),
        unpainted_(grid_.cell_count(), 0),
        found_(members.size(), kNotFound),
        lowest_(members.size(), 0),
        asked_by_(members.size(), no_index) {}

  void visit_all(bool reports) {
    groups_.pieces.reserve(members_.size());
    for (std::uint32_t i = 0; i < members_.size(); ++i) {
      if (found_[i] == kNotFound) visit(i);
      if (reports && i % kReportEvery == 0)
        report_progress(poll_.execution(), "painter", 0.2 + 0.7 * double(i) / double(members_.size()));
    }
  }
  [[nodiscard]] Groups take() { return std::move(groups_); }

 private:
  static constexpr std::uint32_t kNotFound = no_index, kPainted = no_index - 1;

  /// A piece whose neighbours are being searched, and how far the search has come.
  struct Waiting {
    std::uint32_t member;
    PieceGrid::Range cells;
    int x, y;
    std::size_t entry;
  };

  static std::vector<PolygonExtent> extents_of(const Pieces& pieces, const std::vector<std::uint32_t>& members) {
    std::vector<PolygonExtent> extents;
    extents.reserve(members.size());
    for (const std::uint32_t piece : members) extents.push_back(pieces.extent(piece));
    return extents;
  }

  void visit(std::uint32_t root) {
    begin(root);
    while (!waiting_.empty()) {
      const std::uint32_t next = next_covered(waiting_.back());
      if (next != no_index) {
        begin(next);
        continue;
      }
      const std::uint32_t done = waiting_.back().member;
      waiting_.pop_back();
      if (lowest_[done] == found_[done]) paint_from(done);
      if (waiting_.empty()) return;
      const std::uint32_t before = waiting_.back().member;
      lowest_[before] = std::min(lowest_[before], lowest_[done]);
    }
  }

  void begin(std::uint32_t member) {
    found_[member] = lowest_[member] = count_++;
    open_.push_back(member);
    const PieceGrid::Range cells = grid_.range(extents_[member]);
    waiting_.push_back({member, cells, cells.first_x, cells.first_y, 0});
  }

  /// Returns the next piece that must be painted before w.member and was not found yet, or no_index if there are no
  /// more.
  std::uint32_t next_covered(Waiting& w) {
    std::optional<NewellTests> tests;
    for (; w.y <= w.cells.last_y; ++w.y, w.x = w.cells.first_x)
      for (; w.x <= w.cells.last_x; ++w.x, w.entry = 0) {
        const std::uint32_t next = next_in_cell(w, tests);
        if (next != no_index) return next;
      }
    return no_index;
  }

  std::uint32_t next_in_cell(Waiting& w, std::optional<NewellTests>& tests) {
    const std::size_t number = grid_.number(w.x, w.y);
    const std::span<const std::uint32_t> cell = grid_.cell(number);
    std::uint32_t& unpainted = unpainted_[number];
    while (unpainted < cell.size() && found_[cell[unpainted]] == kPainted) ++unpainted;
    const PolygonExtent& own = extents_[w.member];
    const PieceBoxes* const boxes = boxes_of(number);
    poll_.count();
    for (w.entry = std::max(w.entry, std::size_t(unpainted)); w.entry < cell.size(); ++w.entry) {
      if (extents_[cell[w.entry]].farthest <= own.nearest) {
        steps_.depths_apart += cell.size() - w.entry;
        break;
      }
      if (boxes) {
        w.entry += pass_over(*boxes, w, tests);
        if (w.entry >= cell.size()) break;
      }
      const std::uint32_t other = cell[w.entry];
      if (found_[other] == kPainted || other == w.member || asked_by_[other] == w.member) continue;
      asked_by_[other] = w.member;
      if (!covers(own, other, w.member, tests)) continue;
      ++steps_.exchanges;
      if (found_[other] == kNotFound) return other;
      lowest_[w.member] = std::min(lowest_[w.member], found_[other]);
    }
    return no_index;
  }

  /// Returns the boxes of a cell, made when first needed, or null if the cell has few pieces.
  const PieceBoxes* boxes_of(std::size_t cell) {
    const std::span<const std::uint32_t> pieces = grid_.cell(cell);
    if (pieces.size() <= kManyPieces) return nullptr;
    return &boxes_.try_emplace(cell, pieces_, members_, pieces).first->second;
  }

  /// Returns how many of the next pieces this piece cannot cover, because they lie in front of its plane.
  std::size_t pass_over(const PieceBoxes& boxes, const Waiting& w, std::optional<NewellTests>& tests) {
    if (!tests) tests.emplace(pieces_, members_[w.member]);
    std::size_t passed = 0;
    while (const std::size_t count = boxes.count_before(w.entry + passed, tests->plane())) {
      poll_.count();
      passed += count;
    }
    steps_.before += passed;
    return passed;
  }

  bool covers(const PolygonExtent& own, std::uint32_t other, std::uint32_t member, std::optional<NewellTests>& tests) {
    poll_.count();
    const PolygonExtent& e = extents_[other];
    if (e.low.x >= own.high.x || e.high.x <= own.low.x || e.low.y >= own.high.y || e.high.y <= own.low.y) {
      ++steps_.boxes_apart;
      return false;
    }
    if (!tests) tests.emplace(pieces_, members_[member]);
    return tests->covers(members_[other], steps_);
  }

  /// Paints, as one group, the pieces found since `first` that are not painted yet.
  void paint_from(std::uint32_t first) {
    const std::size_t begin = groups_.pieces.size();
    for (;;) {
      const std::uint32_t member = open_.back();
      open_.pop_back();
      found_[member] = kPainted;
      groups_.pieces.push_back(members_[member]);
      if (member == first) break;
    }
    groups_.ends.push_back(groups_.pieces.size());
    const std::size_t size = groups_.pieces.size() - begin;
    if (size == 1) return;
    ++steps_.cycles;
    steps_.largest_cycle = std::max<std::uint64_t>(steps_.largest_cycle, size);
  }

  const Pieces& pieces_;
  const std::vector<std::uint32_t>& members_;
  const std::vector<PolygonExtent> extents_;
  const PieceGrid grid_;
  PaintSteps& steps_;
  Poll& poll_;
  std::vector<std::uint32_t> unpainted_;               ///< by cell: number of painted entries at its beginning
  std::vector<std::uint32_t> found_;                   ///< by member: when it was found, or kPainted
  std::vector<std::uint32_t> lowest_;                  ///< by member: the least found_ of all that were reached from it
  std::vector<std::uint32_t> asked_by_;                ///< by member: the piece that it was tested with last, because
                                                       ///< most pairs meet in several cells
  std::unordered_map<std::size_t, PieceBoxes> boxes_;  ///< by cell
  std::vector<std::uint32_t> open_;
  std::vector<Waiting> waiting_;
  std::uint32_t count_ = 0;
  Groups groups_;
};

}  // namespace

void sort_by_nearest(const Pieces& pieces, std::vector<std::uint32_t>& members, const Execution& execution) {
  sort_by_depth(
      pieces, members, [&](std::uint32_t piece) { return pieces.extent(piece).nearest; }, execution);
}

void sort_by_farthest(const Pieces& pieces, std::vector<std::uint32_t>& members, const Execution& execution) {
  sort_by_depth(
      pieces, members, [&](std::uint32_t piece) { return pieces.extent(piece).farthest; }, execution);
}

Groups depth_sort(const Pieces& pieces, const std::vector<std::uint32_t>& members, bool is_all, PaintSteps& steps,
                  Poll& poll) {
  std::vector<std::uint32_t> sorted = members;
  sort_by_farthest(pieces, sorted, poll.execution());
  Search search(pieces, sorted, steps, poll);
  search.visit_all(is_all);
  return search.take();
}

}  // namespace frontmost::painter_detail
