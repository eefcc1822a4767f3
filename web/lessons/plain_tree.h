// SPDX-License-Identifier: Apache-2.0
// A lesson's hierarchy of boxes: two children a node, scalar arithmetic, all steps recorded. The library's RayIndex has
// sixteen of everything, and gives the same answers.
#pragma once

#include <frontmost/raycast.h>

#include <array>
#include <optional>
#include <vector>

#include "web/camera.h"

namespace frontmost::web {

/// A node with `count` triangles of PlainTree::order, from `first` on. A node without children is a leaf.
struct PlainNode {
  Box box;
  std::uint32_t first = 0, count = 0;
  int level = 0;
  std::array<int, 2> children{-1, -1};

  [[nodiscard]] bool is_leaf() const { return children[0] < 0; }
};

/// The hit of a line with a triangle, at origin + t * direction. `weights` are barycentric coordinates of the hit.
struct PlainHit {
  PrimitiveId id = no_primitive;
  double t = std::numeric_limits<double>::infinity();
  glm::dvec3 weights{0};
};

/// A test of a walk, with its result.
struct PlainStep {
  enum class Verdict : std::uint8_t { met, missed, farther };
  bool is_box = true;
  std::uint32_t number = 0;  ///< number of the node or triangle
  Verdict verdict = Verdict::missed;
  double t = 0;
};

/// The cost of a walk.
struct PlainWork {
  std::uint64_t boxes = 0, triangles = 0;
};

class PlainTree {
 public:
  /// Splits at the median along the longest axis, down to `leaf` triangles. Borrows the surfaces.
  explicit PlainTree(const Surfaces& surfaces, std::uint32_t leaf = 2);

  [[nodiscard]] const std::vector<PlainNode>& nodes() const { return nodes_; }
  [[nodiscard]] int depth() const { return depth_; }

  /// The nearest triangle along a line, visiting the nearer box first. Nodes of `level` count as leaves. `steps` may be
  /// null.
  [[nodiscard]] PlainHit nearest(const SightLine& line, int level, PlainWork& work,
                                 std::vector<PlainStep>* steps = nullptr) const;

 private:
  struct Walk;
  int split(std::uint32_t first, std::uint32_t count, int level, std::uint32_t leaf);
  [[nodiscard]] glm::vec3 middle_of(PrimitiveId id) const;
  void visit(Walk& walk, int number) const;
  void ask_triangles(Walk& walk, const PlainNode& node) const;

  const Surfaces& surfaces_;
  std::vector<PlainNode> nodes_;
  std::vector<PrimitiveId> order_;
  int depth_ = 0;
};

}  // namespace frontmost::web
