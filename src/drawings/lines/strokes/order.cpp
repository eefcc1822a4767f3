// SPDX-License-Identifier: Apache-2.0
// An order of chains with little pen travel: chains whose ends meet are joined, and the next chain begins at the
// nearest end.
//
//    ends left in a box    lowest    Of equally near ends the lowest number is taken. A box is entered only if it may
//    [ 3 7 9 | 4 5 ]         3       hold a nearer end, or one as near with a lower number. Both ends of a chain leave
//      /         .                   the tree when it is drawn, and the lowest numbers are updated on the way up. So
//    [3 7 9]   [4 5]                 crowds of ends cost no more than others.
#include <tuple>

#include "base/parallel.h"
#include "lines/strokes/parts.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::uint32_t no_end = no_index;

/// The position of an end: number 2 i is the beginning of chain i, 2 i + 1 its end.
glm::dvec2 place(const std::vector<Chain>& chains, std::uint32_t number) {
  const Chain& chain = chains[number / 2];
  return number % 2 == 0 || chain.is_closed ? chain.points.front() : chain.points.back();
}

class EndTree {
 public:
  EndTree(const std::vector<Chain>& chains, std::size_t first, std::size_t last) : offset_(2 * first) {
    for (std::size_t i = 2 * first; i < 2 * last; ++i)
      ends_.push_back({place(chains, std::uint32_t(i)), std::uint32_t(i)});
    std::size_t nodes = 1;
    for (std::size_t size = ends_.size(); size > few; size = (size + 1) / 2) nodes = 2 * nodes + 1;
    nodes_.resize(nodes);
    leaf_of_.resize(ends_.size());
    build(0, 0, ends_.size());
  }

  /// The remaining end nearest to `from`, at most at the squared distance `most` and other than `except`; among equals,
  /// the lowest number. no_end if none is left.
  [[nodiscard]] std::uint32_t nearest(const glm::dvec2& from, double most = std::numeric_limits<double>::infinity(),
                                      std::uint32_t except = no_end) const {
    Found best(most, no_end);
    visit(0, from, except, best);
    return best.second;
  }

  void remove(std::uint32_t number) {
    std::size_t node = leaf_of_[number - offset_];
    Node& leaf = nodes_[node];
    const auto at = std::find_if(ends_.begin() + leaf.begin, ends_.begin() + leaf.end,
                                 [&](const End& end) { return end.number == number; });
    std::swap(*at, ends_[--leaf.end]);
    leaf.lowest = no_end;
    for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) leaf.lowest = std::min(leaf.lowest, ends_[i].number);
    for (; node > 0; node = (node - 1) / 2) {
      const std::size_t parent = (node - 1) / 2;
      nodes_[parent].lowest = std::min(nodes_[2 * parent + 1].lowest, nodes_[2 * parent + 2].lowest);
    }
  }

 private:
  using Found = std::pair<double, std::uint32_t>;  ///< squared distance and number
  static constexpr std::size_t few = 8;
  struct End {
    glm::dvec2 at;
    std::uint32_t number;
  };
  /// The children of node i are nodes 2 i + 1 and 2 i + 2.
  struct Node {
    glm::dvec2 low{0}, high{0};
    std::uint32_t begin = 0, end = 0;  ///< range of the remaining ends; leaves only
    std::uint32_t lowest = no_end;
    bool is_leaf = true;
  };

  void build(std::size_t number, std::size_t begin, std::size_t end) {
    Node& node = nodes_[number];
    node = {ends_[begin].at, ends_[begin].at, std::uint32_t(begin), std::uint32_t(end), no_end, end - begin <= few};
    for (std::size_t i = begin; i < end; ++i) {
      node.low = glm::min(node.low, ends_[i].at);
      node.high = glm::max(node.high, ends_[i].at);
      node.lowest = std::min(node.lowest, ends_[i].number);
      leaf_of_[ends_[i].number - offset_] = number;
    }
    if (node.is_leaf) return;
    const int axis = node.high.y - node.low.y > node.high.x - node.low.x;
    const auto at = [&](std::size_t i) { return ends_.begin() + std::ptrdiff_t(i); };
    const std::size_t middle = begin + (end - begin + 1) / 2;
    std::nth_element(at(begin), at(middle), at(end),
                     [&](const End& a, const End& b) { return a.at[axis] < b.at[axis]; });
    build(2 * number + 1, begin, middle);
    build(2 * number + 2, middle, end);
  }

  [[nodiscard]] double distance(std::size_t number, const glm::dvec2& from) const {
    const glm::dvec2 d = glm::clamp(from, nodes_[number].low, nodes_[number].high) - from;
    return glm::dot(d, d);
  }

  void visit(std::size_t number, const glm::dvec2& from, std::uint32_t except, Found& best) const {
    const Node& node = nodes_[number];
    if (node.is_leaf) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        if (ends_[i].number == except) continue;
        const glm::dvec2 d = ends_[i].at - from;
        best = std::min(best, Found(glm::dot(d, d), ends_[i].number));
      }
      return;
    }
    std::size_t below[] = {2 * number + 1, 2 * number + 2};
    double distances[] = {distance(below[0], from), distance(below[1], from)};
    const int first = std::tie(distances[1], nodes_[below[1]].lowest) < std::tie(distances[0], nodes_[below[0]].lowest);
    for (const int i : {first, 1 - first}) {
      const std::uint32_t lowest = nodes_[below[i]].lowest;
      if (lowest != no_end && Found(distances[i], lowest) < best) visit(below[i], from, except, best);
    }
  }

  const std::size_t offset_;  ///< the first end's number
  std::vector<End> ends_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> leaf_of_;
};

void reverse(Chain& chain) {
  std::reverse(chain.points.begin(), chain.points.end());
  if (chain.bulges.empty()) return;
  // The join that began at a point now ends there.
  chain.bulges.pop_back();
  std::reverse(chain.bulges.begin(), chain.bulges.end());
  chain.bulges.push_back(0);
  for (double& bulge : chain.bulges) bulge = -bulge;
}

/// Calls visit(first, last) for each range of chains of one rank.
template <class Visit>
void for_each_rank(const std::vector<Chain>& chains, const Visit& visit) {
  for (std::size_t first = 0, last; first < chains.size(); first = last) {
    last = first + 1;
    while (last < chains.size() && chains[last].rank == chains[first].rank) ++last;
    visit(first, last);
  }
}

/// The direction in which a chain goes on beyond an end, from a point at least `back` before it.
glm::dvec2 direction_beyond(const std::vector<Chain>& chains, std::uint32_t number, double back) {
  const std::vector<glm::dvec2>& points = chains[number / 2].points;
  const auto along = [&](const auto& begin, const auto& end) {
    glm::dvec2 way(0);
    for (auto p = begin; p != end && glm::dot(way, way) <= back * back; ++p) way = *begin - *p;
    return way / std::max(glm::length(way), std::numeric_limits<double>::min());
  };
  return number % 2 == 0 ? along(points.begin(), points.end()) : along(points.rbegin(), points.rend());
}

constexpr double goes_on = 0.866;  // the cosine of 30 degrees

/// Which ends are joined. Paths that are joined so far have two free ends each.
///
/// Each end takes the nearest free end of another path. Only then are paths closed, because a closed path would leave
/// out others that touch it.
class EndPairs {
 public:
  EndPairs(const std::vector<Chain>& chains, double apart, bool any_direction)
      : chains_(chains), apart_(apart), any_direction_(any_direction), partner(2 * chains.size(), no_index) {
    for (std::uint32_t end = 0; end < partner.size(); ++end) opposite_.push_back(end ^ 1);
  }

  /// Joins the ends of the chains from `first` to `last`, which have one rank.
  void join(std::size_t first, std::size_t last, const Execution& execution) {
    EndTree left(chains_, first, last);
    for (std::size_t i = first; i < last; ++i)
      if (chains_[i].is_closed)
        for (const std::size_t end : {2 * i, 2 * i + 1}) left.remove(std::uint32_t(end));
    for (auto end = std::uint32_t(2 * first); end < 2 * last; ++end) {
      if (end % 1024 == 0) check_cancelled(execution);
      if (!is_free(end)) continue;
      left.remove(end);
      const std::uint32_t other = left.nearest(place(chains_, end), apart_ * apart_, opposite_[end]);
      if (other == no_end || !may_join(end, other)) continue;
      left.remove(other);
      join(end, other);
    }
    for (auto end = std::uint32_t(2 * first); end < 2 * last; ++end) {
      const std::uint32_t other = opposite_[end];
      // A straight line is not closed, however short.
      if (!is_free(end) || (other == (end ^ 1) && chains_[end / 2].points.size() < 3)) continue;
      if (glm::distance(place(chains_, end), place(chains_, other)) <= apart_ && may_join(end, other)) join(end, other);
    }
  }

 private:
  [[nodiscard]] bool is_free(std::uint32_t end) const {
    return !chains_[end / 2].is_closed && partner[end] == no_index;
  }

  [[nodiscard]] bool may_join(std::uint32_t a, std::uint32_t b) const {
    return any_direction_ ||
           glm::dot(direction_beyond(chains_, a, apart_), direction_beyond(chains_, b, apart_)) <= -goes_on;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    partner[a] = b;
    partner[b] = a;
    const std::uint32_t from = opposite_[a], to = opposite_[b];
    opposite_[from] = to;
    opposite_[to] = from;
  }

  const std::vector<Chain>& chains_;
  const double apart_;
  const bool any_direction_;
  std::vector<std::uint32_t> opposite_;  ///< by free end: the other free end of its path

 public:
  std::vector<std::uint32_t> partner;  ///< by end: the end that it is joined to, or no_index
};

/// Appends the points of `from`, whose first point is left out if it is the last point of `to`.
void append(const std::vector<glm::dvec2>& from, std::vector<glm::dvec2>& to) {
  const bool is_there = !to.empty() && glm::distance(to.back(), from.front()) * places_per_pixel <= 1;
  to.insert(to.end(), from.begin() + is_there, from.end());
}

}  // namespace

std::vector<Chain> joined_ends(std::vector<Chain> chains, double apart, bool any_direction,
                               const Execution& execution) {
  EndPairs pairs(chains, apart, any_direction);
  for_each_rank(chains, [&](std::size_t first, std::size_t last) { pairs.join(first, last, execution); });
  std::vector<Chain> joined;
  for_each_chain(pairs.partner, [&](const std::vector<std::uint32_t>& ends, bool is_closed) {
    Chain& chain = joined.emplace_back(std::move(chains[ends[0] / 2]));
    if (ends[0] % 2 == 1) reverse(chain);
    for (std::size_t i = 1; i < ends.size(); ++i) {
      Chain& next = chains[ends[i] / 2];
      if (ends[i] % 2 == 1) reverse(next);
      append(next.points, chain.points);
      chain.is_contour |= next.is_contour;
    }
    if (!is_closed) return;
    chain.is_closed = true;
    if (glm::distance(chain.points.front(), chain.points.back()) * places_per_pixel <= 1) chain.points.pop_back();
  });
  std::stable_sort(joined.begin(), joined.end(), [](const Chain& a, const Chain& b) { return a.rank < b.rank; });
  return joined;
}

std::vector<std::uint32_t> pen_order(const std::vector<Chain>& chains, const Execution& execution) {
  std::vector<std::uint32_t> order;
  order.reserve(chains.size());
  for_each_rank(chains, [&](std::size_t first, std::size_t last) {
    EndTree left(chains, first, last);
    glm::dvec2 pen(0);
    for (std::size_t i = first; i < last; ++i) {
      if (i % 1024 == 0) check_cancelled(execution);
      const std::uint32_t end = left.nearest(pen);
      left.remove(end);
      left.remove(end ^ 1);
      order.push_back(end);
      pen = place(chains, end ^ 1);
    }
  });
  return order;
}

std::vector<Chain> nearest_first(std::vector<Chain> chains, const Execution& execution) {
  std::vector<Chain> drawn;
  for (const std::uint32_t end : pen_order(chains, execution)) {
    Chain& chain = drawn.emplace_back(std::move(chains[end / 2]));
    if (end % 2 == 1 && !chain.is_closed) reverse(chain);
  }
  return drawn;
}

}  // namespace frontmost::lines_detail
