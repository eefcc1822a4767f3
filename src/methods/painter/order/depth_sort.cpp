// SPDX-License-Identifier: Apache-2.0
// Newell's exchange, made to end. A piece P is painted once everything that it covers is painted; covered pieces that
// are not painted yet go first. This is a depth-first search: if it comes back to a waiting piece, all pieces in
// between have no order (Tarjan's strongly connected components). Pieces come from far to near, so almost everything
// that one covers is painted already and needs no test. Neighbours are looked for when a piece's turn comes, so no pair
// is ever stored.
//
//    far                                         near
//    [painted ......][ P waits -> Q waits -> R ][ not found yet ...]
//                         ^                |
//                         +---- covers ----+       R covers P, which is waiting: P, Q and R have no order
//
// The search has its own stack, because chains of covering pieces may be as long as there are pieces. Painted pieces at
// the beginning of a cell are skipped at once, and the search in a cell ends where pieces are wholly nearer.
#include <algorithm>
#include <optional>
#include <unordered_map>

#include "painter/order/by_depth.h"
#include "painter/order/newell_tests.h"
#include "painter/order/piece_grid.h"
#include "painter/stages.h"

namespace frontmost::painter_detail {
namespace {

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

  /// A piece whose neighbours are being looked at, and the progress in them.
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

  /// The next piece that must be painted before w.member and was not found yet; no_index: there are no more.
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

  /// Boxes of a cell, made when first needed; null for a few pieces.
  const PieceBoxes* boxes_of(std::size_t cell) {
    const std::span<const std::uint32_t> pieces = grid_.cell(cell);
    if (pieces.size() <= kManyPieces) return nullptr;
    return &boxes_.try_emplace(cell, pieces_, members_, pieces).first->second;
  }

  /// How many of the next pieces this piece cannot cover, because they lie before its plane.
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

  /// Paints the pieces found since `first` that are not painted yet as one group.
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
  std::vector<std::uint32_t> lowest_;                  ///< by member: the lowest of all that were found from it
  std::vector<std::uint32_t> asked_by_;                ///< by member: avoids repeated tests, as most pairs meet in
                                                       ///< several cells
  std::unordered_map<std::size_t, PieceBoxes> boxes_;  ///< by cell
  std::vector<std::uint32_t> open_;
  std::vector<Waiting> waiting_;
  std::uint32_t count_ = 0;
  Groups groups_;
};

}  // namespace

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
