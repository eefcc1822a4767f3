// SPDX-License-Identifier: Apache-2.0
// Crumbs are strokes too short to be worth drawing.
//
// A crumb that ends in the air is removed; this may leave other crumbs with an end in the air. A crumb that remains is
// joined to a line that begins where it ends.
//
//        a ________________ b          c ends in the air and is removed. d holds a line that would end in the air
//              |    d/                 otherwise, so d stays or becomes the end of that line. The lines that pass
//             c     /________ e        near the ends of crumbs show, once for all, which ends touch something.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

#include "base/parallel.h"
#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

double length_of(const Chain& chain) {
  double length = 0;
  for (std::size_t i = 1; i < chain.points.size(); ++i) length += glm::distance(chain.points[i - 1], chain.points[i]);
  if (chain.is_closed) length += glm::distance(chain.points.back(), chain.points.front());
  return length;
}

double distance_to(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0;
  return glm::distance(p, a + t * along);
}

/// An end of a crumb: number 2 i for the first point of chain i, 2 i + 1 for its last.
struct CrumbEnd {
  glm::dvec2 at;
  std::size_t number;
};

/// The ends of crumbs in a grid of square cells.
class EndGrid {
 public:
  explicit EndGrid(double cell) : cell_(cell) {}

  void add(const CrumbEnd& end) { cells_[key(column(end.at.x), column(end.at.y))].push_back(end); }

  /// Calls visit(end) for all ends within `distance` of the segment, and for others nearby. `distance` is less than a
  /// cell.
  template <class Visit>
  void for_each(const glm::dvec2& a, const glm::dvec2& b, double distance, const Visit& visit) const {
    const glm::dvec2 low = glm::min(a, b) - distance, high = glm::max(a, b) + distance;
    for (std::int64_t x = column(low.x); x <= column(high.x); ++x) {
      // A long slanting segment visits only the rows that it passes in this column.
      double y0 = a.y, y1 = b.y;
      if (std::abs(b.x - a.x) > cell_) {
        const auto y_at = [&](double at) { return a.y + (b.y - a.y) * std::clamp((at - a.x) / (b.x - a.x), 0.0, 1.0); };
        y0 = y_at(double(x) * cell_ - distance);
        y1 = y_at(double(x + 1) * cell_ + distance);
      }
      for (std::int64_t y = column(std::min(y0, y1) - distance); y <= column(std::max(y0, y1) + distance); ++y)
        if (const auto found = cells_.find(key(x, y)); found != cells_.end())
          for (const CrumbEnd& end : found->second) visit(end);
    }
  }

 private:
  [[nodiscard]] std::int64_t column(double x) const { return std::int64_t(std::floor(x / cell_)); }
  static std::uint64_t key(std::int64_t x, std::int64_t y) {
    return std::uint64_t(x) << 32 ^ (std::uint64_t(y) & 0xFFFFFFFFu);
  }

  const double cell_;
  std::unordered_map<std::uint64_t, std::vector<CrumbEnd>> cells_;
};

/// A chain on which an end of a crumb lies.
struct Touch {
  std::size_t end, chain;
  bool is_at_end;  ///< it also is an end of that chain

  friend bool operator<(const Touch& a, const Touch& b) {
    return std::tie(a.end, a.chain, b.is_at_end) < std::tie(b.end, b.chain, a.is_at_end);
  }
};

class Crumbs {
 public:
  Crumbs(std::vector<Chain>& chains, const CrumbRule& rule, const Execution& execution)
      : chains_(chains), rule_(rule), execution_(execution), is_crumb_(chains.size()), is_left_out_(chains.size()) {
    for (std::size_t i = 0; i < chains.size(); ++i) is_crumb_[i] = length_of(chains[i]) < rule.shortest;
  }

  void leave_out() {
    find_touches();
    std::vector<std::size_t> asked;
    for (std::size_t i = 0; i < chains_.size(); ++i)
      if (is_crumb_[i]) asked.push_back(i);
    while (!asked.empty()) {
      const std::size_t i = asked.back();
      asked.pop_back();
      if (is_left_out_[i] || !is_loose(i)) continue;
      is_left_out_[i] = true;
      // Crumbs that ended on this one may be loose now.
      for (const std::size_t other : touched_by_[i]) asked.push_back(other);
    }
  }

  void join();

  std::vector<Chain> take() {
    std::vector<Chain> kept;
    for (std::size_t i = 0; i < chains_.size(); ++i)
      if (!is_left_out_[i]) kept.push_back(std::move(chains_[i]));
    return kept;
  }

 private:
  [[nodiscard]] const glm::dvec2& place(std::size_t end) const {
    const Chain& chain = chains_[end / 2];
    return end % 2 == 0 ? chain.points.front() : chain.points.back();
  }

  void find_touches() {
    EndGrid ends(rule_.shortest);
    for (std::size_t i = 0; i < chains_.size(); ++i)
      if (is_crumb_[i] && !chains_[i].is_closed)
        for (std::size_t end = 2 * i; end < 2 * i + 2; ++end) ends.add({place(end), end});
    touched_by_.resize(chains_.size());
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      if (i % 1024 == 0) check_cancelled(execution_);
      const Chain& chain = chains_[i];
      const std::size_t joins = chain.points.size() - (chain.is_closed ? 0 : 1);
      for (std::size_t k = 0; k < joins; ++k)
        find_touches(i, chain.points[k], chain.points[k + 1 == chain.points.size() ? 0 : k + 1], ends);
    }
    std::sort(touches_.begin(), touches_.end());
    touches_.erase(std::unique(touches_.begin(), touches_.end(),
                               [](const Touch& a, const Touch& b) { return a.end == b.end && a.chain == b.chain; }),
                   touches_.end());
    for (const Touch& touch : touches_) touched_by_[touch.chain].push_back(touch.end / 2);
  }

  void find_touches(std::size_t chain, const glm::dvec2& a, const glm::dvec2& b, const EndGrid& ends) {
    ends.for_each(a, b, rule_.touching, [&](const CrumbEnd& end) {
      const std::size_t crumb = end.number / 2;
      // Hidden chains hold no visible ones.
      if (crumb == chain || (rule_.is_hidden(chains_[chain].rank) && !rule_.is_hidden(chains_[crumb].rank))) return;
      if (distance_to(end.at, a, b) > rule_.touching) return;
      const bool is_at_end =
          !chains_[chain].is_closed && std::min(glm::distance(end.at, place(2 * chain)),
                                                glm::distance(end.at, place(2 * chain + 1))) <= rule_.touching;
      touches_.push_back({end.number, chain, is_at_end});
    });
  }

  /// Whether the crumb may be removed: one of its ends is in the air, or it is not of a contour and only connects lines
  /// that continue without it.
  [[nodiscard]] bool is_loose(std::size_t crumb) const {
    if (chains_[crumb].is_closed) return !chains_[crumb].is_contour;
    bool is_link = true;
    for (std::size_t end = 2 * crumb; end < 2 * crumb + 2; ++end) {
      bool is_held = false, meets_end = false;
      for (auto touch = std::lower_bound(touches_.begin(), touches_.end(), Touch{end, 0, true});
           touch != touches_.end() && touch->end == end; ++touch) {
        if (is_left_out_[touch->chain]) continue;
        is_held = true;
        meets_end |= touch->is_at_end;
      }
      if (!is_held) return true;
      is_link &= meets_end;
    }
    return !is_link && !chains_[crumb].is_contour;
  }

  std::vector<Chain>& chains_;
  const CrumbRule& rule_;
  const Execution& execution_;
  std::vector<bool> is_crumb_, is_left_out_;
  std::vector<Touch> touches_;                        ///< ascending
  std::vector<std::vector<std::size_t>> touched_by_;  ///< by chain: the crumbs that end on it
};

/// The ends of open chains by rank and place.
class EndTable {
 public:
  using Key = std::tuple<std::uint32_t, std::int64_t, std::int64_t>;

  static Key key(const Chain& chain, bool is_last) {
    const glm::dvec2& p = is_last ? chain.points.back() : chain.points.front();
    return {chain.rank, std::llround(p.x * places_per_pixel), std::llround(p.y * places_per_pixel)};
  }
  void add(const Chain& chain, std::size_t number) {
    for (const bool is_last : {false, true}) ends_.emplace(key(chain, is_last), 2 * number + is_last);
  }
  void remove(const Chain& chain, std::size_t number) {
    for (const bool is_last : {false, true}) {
      auto [at, end] = ends_.equal_range(key(chain, is_last));
      while (at != end && at->second != 2 * number + is_last) ++at;
      if (at != end) ends_.erase(at);
    }
  }
  [[nodiscard]] auto at(const Key& key) const { return ends_.equal_range(key); }

 private:
  std::multimap<Key, std::size_t> ends_;
};

/// The unit direction of the chain at its end, pointing out of the chain.
glm::dvec2 direction_at(const Chain& chain, bool is_last) {
  const std::size_t n = chain.points.size();
  const glm::dvec2 d = is_last ? chain.points[n - 1] - chain.points[n - 2] : chain.points[0] - chain.points[1];
  return d / std::max(glm::length(d), 1e-300);
}

void Crumbs::join() {
  EndTable ends;
  for (std::size_t i = 0; i < chains_.size(); ++i)
    if (!is_left_out_[i] && !chains_[i].is_closed) ends.add(chains_[i], i);
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    if (!is_crumb_[i] || is_left_out_[i] || chains_[i].is_closed) continue;
    // Finds the end of another chain that continues this crumb most straightly.
    std::size_t best = 0, own = 0;
    double straightest = 2;
    for (const bool is_last : {false, true}) {
      const auto [begin, end] = ends.at(EndTable::key(chains_[i], is_last));
      for (auto other = begin; other != end; ++other) {
        if (other->second / 2 == i) continue;
        const double cosine = glm::dot(direction_at(chains_[i], is_last),
                                       direction_at(chains_[other->second / 2], other->second % 2 == 1));
        if (cosine < straightest) straightest = cosine, best = other->second, own = is_last;
      }
    }
    if (straightest > 1) continue;
    Chain &crumb = chains_[i], &line = chains_[best / 2];
    ends.remove(crumb, i);
    ends.remove(line, best / 2);
    if (own == 1) std::reverse(crumb.points.begin(), crumb.points.end());
    if (best % 2 == 0) std::reverse(line.points.begin(), line.points.end());
    line.points.insert(line.points.end(), crumb.points.begin() + 1, crumb.points.end());
    line.is_contour |= crumb.is_contour;
    is_left_out_[i] = true;
    ends.add(line, best / 2);
  }
}

}  // namespace

std::vector<Chain> without_crumbs(std::vector<Chain> chains, const CrumbRule& rule, const Execution& execution) {
  Crumbs crumbs(chains, rule, execution);
  crumbs.leave_out();
  crumbs.join();
  return crumbs.take();
}

}  // namespace frontmost::lines_detail
