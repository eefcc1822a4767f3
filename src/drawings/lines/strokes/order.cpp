// SPDX-License-Identifier: Apache-2.0
// An order of chains with little pen travel: the next chain begins at the nearest end.
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

  /// The remaining end nearest to `from`; among equals, the lowest number. Precondition: at least one remains.
  [[nodiscard]] std::uint32_t nearest(const glm::dvec2& from) const {
    Found best(std::numeric_limits<double>::infinity(), no_end);
    visit(0, from, best);
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
  using Found = std::pair<double, std::uint32_t>;  ///< distance and number

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

  void visit(std::size_t number, const glm::dvec2& from, Found& best) const {
    const Node& node = nodes_[number];
    if (node.is_leaf) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
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
      if (lowest != no_end && Found(distances[i], lowest) < best) visit(below[i], from, best);
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

/// Appends `chain`, or joins it to the last chain if both are open and touch.
void draw(Chain&& chain, double touching, std::size_t first, std::vector<Chain>& drawn) {
  if (drawn.size() > first && !drawn.back().is_closed && !chain.is_closed &&
      glm::distance(drawn.back().points.back(), chain.points.front()) <= touching) {
    Chain& last = drawn.back();
    const bool has_bulges = !last.bulges.empty() || !chain.bulges.empty();
    if (has_bulges) {
      last.bulges.resize(last.points.size(), 0);
      chain.bulges.resize(chain.points.size(), 0);
      last.bulges.pop_back();
      last.bulges.insert(last.bulges.end(), chain.bulges.begin(), chain.bulges.end());
    }
    last.points.pop_back();
    last.points.insert(last.points.end(), chain.points.begin(), chain.points.end());
    return;
  }
  drawn.push_back(std::move(chain));
}

}  // namespace

std::vector<Chain> nearest_first(std::vector<Chain> chains, double touching, const Execution& execution) {
  std::vector<Chain> drawn;
  for (std::size_t first = 0; first < chains.size();) {
    std::size_t last = first + 1;
    while (last < chains.size() && chains[last].rank == chains[first].rank) ++last;
    EndTree left(chains, first, last);
    const std::size_t begin = drawn.size();
    glm::dvec2 pen(0);
    for (std::size_t i = first; i < last; ++i) {
      if (i % 1024 == 0) check_cancelled(execution);
      const std::uint32_t number = left.nearest(pen);
      left.remove(number);
      left.remove(number ^ 1);
      Chain& chain = chains[number / 2];
      if (number % 2 == 1 && !chain.is_closed) reverse(chain);
      pen = chain.is_closed ? chain.points.front() : chain.points.back();
      draw(std::move(chain), touching, begin, drawn);
    }
    first = last;
  }
  return drawn;
}

}  // namespace frontmost::lines_detail
