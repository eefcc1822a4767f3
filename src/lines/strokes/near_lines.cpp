// SPDX-License-Identifier: Apache-2.0
#include "lines/strokes/near_lines.h"

#include <numbers>

namespace frontmost::lines_detail {
namespace {

constexpr double half_turn = std::numbers::pi;

struct Bounds {
  double low, high;
  [[nodiscard]] bool meets(double reach) const { return low <= reach && high >= -reach; }
};

}  // namespace

SoughtLine::SoughtLine(const Line& line, const Nearness& nearness)
    : from(line.from),
      to(line.to),
      middle((line.from + line.to) / 2.0),
      along(line.along),
      half(line.length / 2),
      reach(nearness.reach_of(line.length)),
      turn(line.is_long() ? Nearness::most_slope * (1 + 1e-4) : Nearness::most_short_slope) {}

LineTree::OverAxis LineTree::OverAxis::of(const Segment& segment, const glm::dvec2& axis, std::uint32_t number) {
  double x0 = glm::dot(axis, segment.from), x1 = glm::dot(axis, segment.to);
  double y0 = cross(axis, segment.from), y1 = cross(axis, segment.to);
  if (x0 > x1) {
    std::swap(x0, x1);
    std::swap(y0, y1);
  }
  return {x0, x1, y0, (y1 - y0) / (x1 - x0), number};
}

/// Where they lie on each other the line runs between the node's lowest and highest one, and at whatever place all of
/// the node's have in common with it, if there is one, it does so, too.
bool LineTree::Node::may_hold(const OverAxis& line, double reach) const {
  reach *= OverAxis::upwards;
  const double from = std::max(begin, line.x0 - reach), to = std::min(end, line.x1 + reach);
  if (from > to) return false;
  const auto above_line = [&](double x) {
    const double share = end > begin ? (x - begin) / (end - begin) : 0, height = line.at(x);
    return Bounds{low_at_begin + (low_at_end - low_at_begin) * share - height,
                  high_at_begin + (high_at_end - high_at_begin) * share - height};
  };
  const Bounds at_from = above_line(from), at_to = above_line(to);
  if ((at_from.low > reach && at_to.low > reach) || (at_from.high < -reach && at_to.high < -reach)) return false;
  const double common_from = std::max(last_begin, line.x0) + reach, common_to = std::min(first_end, line.x1) - reach;
  return !(common_from < common_to) || (above_line(common_from).meets(reach) && above_line(common_to).meets(reach));
}

LineTree::LineTree(std::vector<OverAxis> lines, double near) : lines_(std::move(lines)) {
  std::size_t nodes = 1;
  for (std::size_t size = lines_.size(); size > leaf; size = (size + 1) / 2) nodes = 2 * nodes + 1;
  nodes_.resize(nodes);
  build(0, 0, lines_.size(), near);
}

LineTree::Node LineTree::node_of(std::size_t first, std::size_t last) const {
  const OverAxis& one = lines_[first];
  Node node{
      one.x0, one.x0, one.x1, one.x1, 1e300, -1e300, 1e300, -1e300, std::uint32_t(first), std::uint32_t(last - first)};
  for (std::size_t i = first; i < last; ++i) {
    const OverAxis& line = lines_[i];
    node.begin = std::min(node.begin, line.x0);
    node.last_begin = std::max(node.last_begin, line.x0);
    node.first_end = std::min(node.first_end, line.x1);
    node.end = std::max(node.end, line.x1);
  }
  for (std::size_t i = first; i < last; ++i) {
    const double at_begin = lines_[i].at(node.begin), at_end = lines_[i].at(node.end);
    node.low_at_begin = std::min(node.low_at_begin, at_begin);
    node.high_at_begin = std::max(node.high_at_begin, at_begin);
    node.low_at_end = std::min(node.low_at_end, at_end);
    node.high_at_end = std::max(node.high_at_end, at_end);
  }
  return node;
}

void LineTree::build(std::size_t number, std::size_t first, std::size_t last, double near) {
  nodes_[number] = node_of(first, last);
  if (last - first <= leaf) return;
  const std::size_t middle = first + (last - first + 1) / 2;
  part(first, middle, last, near);
  build(2 * number + 1, first, middle, near);
  build(2 * number + 2, middle, last, near);
}

/// In two by where lines begin, end, how high they run or how they slope: by what differs the most, held against what
/// parts two lines.
void LineTree::part(std::size_t first, std::size_t middle, std::size_t last, double near) {
  double length = 0, slope = 0;
  for (std::size_t i = first; i < last; ++i) {
    length += lines_[i].x1 - lines_[i].x0;
    slope += lines_[i].slope;
  }
  length /= double(last - first);
  slope /= double(last - first);
  const double within = length / 4, apart = std::min(near, within);
  const auto value = [&](const OverAxis& line, int by) {
    switch (by) {
      case 0: return line.x0 / within;
      case 1: return line.x1 / within;
      case 2: return line.slope * length / apart;
      default: {
        const double x = (line.x0 + line.x1) / 2;
        return (line.at(x) - slope * x) / apart;
      }
    }
  };
  double most = -1;
  int widest = 0;
  for (int by = 0; by < 4; ++by) {
    double low = 1e300, high = -1e300;
    for (std::size_t i = first; i < last; ++i) {
      low = std::min(low, value(lines_[i], by));
      high = std::max(high, value(lines_[i], by));
    }
    if (high - low > most) most = high - low, widest = by;
  }
  const auto at = [&](std::size_t i) { return lines_.begin() + std::ptrdiff_t(i); };
  std::nth_element(at(first), at(middle), at(last),
                   [&](const OverAxis& a, const OverAxis& b) { return value(a, widest) < value(b, widest); });
}

/// From 0 to half a turn: either way along the line.
double NearLines::angle_of(const glm::dvec2& along) {
  const double angle = std::atan2(along.y, along.x);
  return angle < 0 ? angle + half_turn : angle;
}

int NearLines::direction_of(double angle) { return int(std::floor(angle * (directions / half_turn))); }

std::vector<std::uint32_t> NearLines::numbers() const {
  std::vector<std::uint32_t> all;
  for (const Few& one : few_) all.push_back(one.number);
  return all;
}

void NearLines::add(std::uint32_t number, const std::vector<Line>& all, const Nearness& nearness) {
  const Line& line = all[number];
  if (!by_direction_.empty()) return add_by_direction(number, line, nearness);
  if (few_.size() < few) {
    few_.push_back({glm::vec2((line.from + line.to) / 2.0), glm::vec2((line.to - line.from) / 2.0), number});
    return;
  }
  by_direction_.resize(directions);
  for (int i = 0; i < directions; ++i) {
    const double angle = (i + 0.5) * (half_turn / directions);
    by_direction_[std::size_t(i)].axis = {std::cos(angle), std::sin(angle)};
  }
  for (const Few& one : few_) add_by_direction(one.number, all[one.number], nearness);
  add_by_direction(number, line, nearness);
  few_ = {};
}

void NearLines::add_by_direction(std::uint32_t number, const Line& line, const Nearness& nearness) {
  Direction& direction = by_direction_[std::size_t(direction_of(angle_of(line.along)) % directions)];
  direction.rest.push_back(number);
  direction.rest_over_axis.push_back(LineTree::OverAxis::of(line, direction.axis, number));
  if (direction.rest.size() < few_of_direction) return;
  std::vector<LineTree::OverAxis> lines = std::move(direction.rest_over_axis);
  direction.rest = {};
  direction.rest_over_axis = {};
  for (LineTree& tree : direction.trees) {
    if (tree.is_empty()) {
      tree = LineTree(std::move(lines), nearness.apart());
      return;
    }
    const std::vector<LineTree::OverAxis> merged = tree.take();
    lines.insert(lines.end(), merged.begin(), merged.end());
    tree = {};
  }
  direction.trees.emplace_back(std::move(lines), nearness.apart());
}

}  // namespace frontmost::lines_detail
