// SPDX-License-Identifier: Apache-2.0
// Lines that are asked which of them may lie on another.
//
// A few are gone through. Where more come together, as in a detail of which thousands pass one pixel, they are parted
// by direction, and those of one direction lie in trees whose nodes know where all of theirs run. Trees are as large as
// powers of two, and are merged as lines are added, O(n log^2 n) in all. (J. Bentley, J. Saxe. Decomposable Searching
// Problems. 1980.)
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lines/strokes/nearness.h"

namespace frontmost::lines_detail {

/// A line for which others are sought that may lie on it.
struct SoughtLine {
  SoughtLine(const Line& line, const Nearness& nearness);

  glm::dvec2 from, to, middle, along;
  double half;   ///< of the length
  double reach;  ///< how far away they may lie
  double turn;   ///< the tangent of the angle to them, at most
};

/// Lines of one direction, or nearly.
class LineTree {
 public:
  /// A line over an axis: y0 + slope * (x - x0) from x0 to x1.
  struct OverAxis {
    /// Measured upwards, a distance from a line is more than across it, by up to this: they turn from the axis by 33
    /// degrees at most, by what lies on each other and half a direction.
    static constexpr double upwards = 1.25;

    double x0, x1, y0, slope;
    std::uint32_t number;

    /// Along a unit vector.
    [[nodiscard]] static OverAxis of(const Segment& segment, const glm::dvec2& axis, std::uint32_t number);
    [[nodiscard]] double at(double x) const { return y0 + slope * (x - x0); }
    [[nodiscard]] bool may_lie_on(const OverAxis& line, double reach) const;
  };

  LineTree() = default;
  /// `near`: how far from each other long ones are that are of interest.
  LineTree(std::vector<OverAxis> lines, double near);

  /// Calls visit(numbers) for those that may lie on the line, at `reach` from it at most.
  template <class Visit>
  void for_each(const OverAxis& line, double reach, const Visit& visit) const {
    if (!nodes_.empty()) for_each_in(0, line, reach, visit);
  }
  [[nodiscard]] bool is_empty() const { return lines_.empty(); }
  [[nodiscard]] std::vector<OverAxis> take() { return std::move(lines_); }

 private:
  static constexpr std::size_t leaf = 16;
  /// Node i has the nodes 2 i + 1 and 2 i + 2 below it.
  struct Node {
    double begin, last_begin, first_end, end;                     ///< of x0 the least and most, and of x1
    double low_at_begin, high_at_begin, low_at_end, high_at_end;  ///< of the lines, prolonged
    std::uint32_t first, count;

    [[nodiscard]] bool may_hold(const OverAxis& line, double reach) const;
  };

  void build(std::size_t number, std::size_t first, std::size_t last, double near);
  [[nodiscard]] Node node_of(std::size_t first, std::size_t last) const;
  void part(std::size_t first, std::size_t middle, std::size_t last, double near);

  template <class Visit>
  void for_each_in(std::size_t number, const OverAxis& line, double reach, const Visit& visit) const {
    const Node& node = nodes_[number];
    if (!node.may_hold(line, reach)) return;
    if (node.count <= leaf) {
      std::array<std::uint32_t, leaf> found;
      std::size_t count = 0;
      for (const OverAxis& one : std::span(lines_).subspan(node.first, node.count)) {
        found[count] = one.number;
        count += one.may_lie_on(line, reach);
      }
      return visit(std::span<const std::uint32_t>(found.data(), count));
    }
    for_each_in(2 * number + 1, line, reach, visit);
    for_each_in(2 * number + 2, line, reach, visit);
  }

  std::vector<OverAxis> lines_;
  std::vector<Node> nodes_;
};

class NearLines {
 public:
  /// Adds the line of that number of `all`, which has those that were added before, too.
  void add(std::uint32_t number, const std::vector<Line>& all, const Nearness& nearness);

  /// Whether they are as many as are gone through one by one: from the next one on they are parted.
  [[nodiscard]] bool is_full() const { return few_.size() == few; }
  /// Precondition: not parted.
  [[nodiscard]] std::vector<std::uint32_t> numbers() const;

  /// Calls visit(numbers) for some of the lines: all that have a stretch by Nearness::overlap() are among them.
  template <class Visit>
  void for_each(const SoughtLine& line, const Visit& visit) const {
    if (!by_direction_.empty()) return for_each_direction(line, visit);
    std::array<std::uint32_t, few> found;
    std::size_t count = 0;
    for (const Few& one : few_) {
      found[count] = one.number;
      count += one.may_lie_on(line);
    }
    visit(std::span<const std::uint32_t>(found.data(), count));
  }

 private:
  static constexpr std::size_t few = 256, few_of_direction = 32;
  static constexpr int directions = 16;

  struct Few {
    glm::vec2 middle, half;
    std::uint32_t number;
    [[nodiscard]] bool may_lie_on(const SoughtLine& line) const;
  };
  struct Direction {
    glm::dvec2 axis{0};
    std::vector<std::uint32_t> rest;
    std::vector<LineTree::OverAxis> rest_over_axis;
    std::vector<LineTree> trees;  ///< the i-th is empty, or has few_of_direction * 2^i lines
  };

  void add_by_direction(std::uint32_t number, const Line& line, const Nearness& nearness);

  template <class Visit>
  void for_each_direction(const SoughtLine& line, const Visit& visit) const {
    const double angle = angle_of(line.along), spread = std::atan(line.turn) + 1e-3;
    for (int i = direction_of(angle - spread); i <= direction_of(angle + spread); ++i) {
      const Direction& direction = by_direction_[std::size_t((i + directions) % directions)];
      if (!direction.rest.empty()) visit(std::span<const std::uint32_t>(direction.rest));
      if (direction.trees.empty()) continue;
      const auto over_axis = LineTree::OverAxis::of({line.from, line.to, 0}, direction.axis, 0);
      for (const LineTree& tree : direction.trees) tree.for_each(over_axis, line.reach, visit);
    }
  }
  [[nodiscard]] static double angle_of(const glm::dvec2& along);
  [[nodiscard]] static int direction_of(double angle);

  std::vector<Few> few_;
  std::vector<Direction> by_direction_;  ///< has all, instead, if it is not empty
};

/// Where they lie on each other, from the last beginning to the first end or nearly, they are not far apart.
inline bool LineTree::OverAxis::may_lie_on(const OverAxis& line, double reach) const {
  reach *= upwards;
  const double from = std::max(x0, line.x0) + reach, to = std::min(x1, line.x1) - reach;
  if (from > to) return to + 4 * reach > from;
  return std::abs(at(from) - line.at(from)) <= reach && std::abs(at(to) - line.at(to)) <= reach;
}

inline bool NearLines::Few::may_lie_on(const SoughtLine& line) const {
  const glm::dvec2 other(half), apart = glm::dvec2(middle) - line.middle;
  const double across = std::abs(cross(line.along, other)), along = std::abs(glm::dot(line.along, other));
  // What floats leave of the place, and more.
  const double slack = 1e-6 * (1 + std::abs(double(middle.x)) + std::abs(double(middle.y)) + along + across);
  return !(std::abs(cross(line.along, apart)) > line.reach + across + slack) &
         !(std::abs(glm::dot(line.along, apart)) > line.half + along + slack) &
         !(across > line.turn * along * (1 + 1e-6) + slack);
}

}  // namespace frontmost::lines_detail
