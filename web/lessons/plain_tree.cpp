// SPDX-License-Identifier: Apache-2.0
#include "web/lessons/plain_tree.h"

#include <algorithm>
#include <numeric>

namespace frontmost::web {
namespace {

/// The hit of a line with a triangle (T. Möller, B. Trumbore. Fast, Minimum Storage Ray/Triangle Intersection. 1997.)
std::optional<PlainHit> meet(const SightLine& line, const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a(corners[0]), ab = glm::dvec3(corners[1]) - a, ac = glm::dvec3(corners[2]) - a;
  const glm::dvec3 p = glm::cross(line.direction, ac);
  const double volume = glm::dot(ab, p);
  if (volume == 0) return std::nullopt;
  const glm::dvec3 from_a = line.origin - a, q = glm::cross(from_a, ab);
  const double u = glm::dot(from_a, p) / volume, v = glm::dot(line.direction, q) / volume;
  const double t = glm::dot(ac, q) / volume;
  if (u < 0 || v < 0 || u + v > 1 || t <= 0) return std::nullopt;
  return PlainHit{no_primitive, t, {1 - u - v, u, v}};
}

/// The parameter at which a line enters a box; empty if it misses the box.
std::optional<double> entry(const SightLine& line, const Box& box) {
  double in = 0, out = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.low[axis] - line.origin[axis], high = box.high[axis] - line.origin[axis];
    if (line.direction[axis] == 0) {
      if (low > 0 || high < 0) return std::nullopt;
      continue;
    }
    const double a = low / line.direction[axis], b = high / line.direction[axis];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return in <= out ? std::optional(in) : std::nullopt;
}

}  // namespace

struct PlainTree::Walk {
  const SightLine& line;
  int level;
  PlainWork& work;
  std::vector<PlainStep>* steps;
  PlainHit nearest{};

  void note(const PlainStep& step) const {
    if (steps) steps->push_back(step);
  }
};

PlainTree::PlainTree(const Surfaces& surfaces, std::uint32_t leaf) : surfaces_(surfaces) {
  order_.resize(surfaces.primitive_count());
  std::iota(order_.begin(), order_.end(), PrimitiveId(0));
  if (!order_.empty()) split(0, std::uint32_t(order_.size()), 0, std::max(leaf, 1u));
}

glm::vec3 PlainTree::middle_of(PrimitiveId id) const {
  const std::array<glm::vec3, 3> corners = surfaces_.corners(id);
  return corners[0] + corners[1] + corners[2];
}

int PlainTree::split(std::uint32_t first, std::uint32_t count, int level, std::uint32_t leaf) {
  const int number = int(nodes_.size());
  nodes_.push_back({{}, first, count, level});
  depth_ = std::max(depth_, level);
  Box box, middles;
  const auto begin = order_.begin() + first;
  for (auto id = begin; id != begin + count; ++id) {
    for (const glm::vec3& corner : surfaces_.corners(*id)) box.include(corner);
    middles.include(middle_of(*id));
  }
  nodes_[std::size_t(number)].box = box;
  const glm::vec3 size = middles.high - middles.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  if (count <= leaf || !(size[axis] > 0)) return number;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count, [&](PrimitiveId a, PrimitiveId b) {
    const float at_a = middle_of(a)[axis], at_b = middle_of(b)[axis];
    return at_a < at_b || (at_a == at_b && a < b);
  });
  const int low = split(first, half, level + 1, leaf), high = split(first + half, count - half, level + 1, leaf);
  nodes_[std::size_t(number)].children = {low, high};
  return number;
}

void PlainTree::ask_triangles(Walk& walk, const PlainNode& node) const {
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    ++walk.work.triangles;
    PlainStep step{false, order_[i], PlainStep::Verdict::missed, 0};
    if (std::optional<PlainHit> hit = meet(walk.line, surfaces_.corners(order_[i]))) {
      hit->id = order_[i];
      const PlainHit& best = walk.nearest;
      const bool is_nearer = hit->t < best.t || (hit->t == best.t && hit->id < best.id);
      step.verdict = is_nearer ? PlainStep::Verdict::met : PlainStep::Verdict::farther;
      step.t = hit->t;
      if (is_nearer) walk.nearest = *hit;
    }
    walk.note(step);
  }
}

/// Visits a box that the line enters.
void PlainTree::visit(Walk& walk, int number) const {
  const PlainNode& node = nodes_[std::size_t(number)];
  if (node.is_leaf()) return ask_triangles(walk, node);
  if (node.level == walk.level) {
    // All triangles are tested. The rest of the tree finds the answer faster; its work is not counted.
    PlainWork uncounted;
    Walk below{walk.line, std::numeric_limits<int>::max(), uncounted, nullptr, walk.nearest};
    for (const int child : node.children) visit(below, child);
    walk.nearest = below.nearest;
    walk.work.triangles += node.count;
    return;
  }
  std::array<std::optional<double>, 2> entries;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto child = std::size_t(node.children[i]);
    entries[i] = entry(walk.line, nodes_[child].box);
    ++walk.work.boxes;
    walk.note({true, std::uint32_t(child), entries[i] ? PlainStep::Verdict::met : PlainStep::Verdict::missed,
               entries[i].value_or(0)});
  }
  const std::size_t nearer = entries[1] && (!entries[0] || *entries[1] < *entries[0]) ? 1 : 0;
  for (const std::size_t i : {nearer, 1 - nearer}) {
    if (!entries[i]) continue;
    // The hit in the nearer box may lie before all of the other box.
    if (*entries[i] > walk.nearest.t)
      walk.note({true, std::uint32_t(node.children[i]), PlainStep::Verdict::farther, *entries[i]});
    else
      visit(walk, node.children[i]);
  }
}

PlainHit PlainTree::nearest(const SightLine& line, int level, PlainWork& work, std::vector<PlainStep>* steps) const {
  Walk walk{line, level, work, steps};
  if (nodes_.empty()) return walk.nearest;
  const std::optional<double> first = entry(line, nodes_.front().box);
  ++work.boxes;
  walk.note({true, 0, first ? PlainStep::Verdict::met : PlainStep::Verdict::missed, first.value_or(0)});
  if (first) visit(walk, 0);
  return walk.nearest;
}

}  // namespace frontmost::web
