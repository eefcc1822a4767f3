// SPDX-License-Identifier: Apache-2.0
// Helpers for readers of polygons. Most files hold only triangles, which take a short way: their corners are not
// copied, nothing is cut, and no list of faces is kept while each polygon so far was one triangle.
//
// Polygons are cut by ear clipping with exact predicates. Each cut takes a triangle of the polygon's winding, so signed
// areas add up: if a polygon does not cross itself, triangles that all turn left cover it exactly once. So a fan whose
// triangles all turn left needs no further test. It serves all convex polygons. Cutting takes O(n log n), unless ears
// are far apart: the search for an ear takes O(n) tests at worst.
//
// If an outline touches itself, edges that should coincide cross slightly by rounding, unless they share both corners.
// Then there may be no ear left, and a triangle turns the other way. In that case all triangulations are tried, which
// takes O(n^3), and the one with the least area of such triangles is chosen.
#include "io/models/mesh_building.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/orientation.h"
#include "base/srgb.h"

namespace frontmost {
namespace {

/// An ear a, b, c with its tip at b, counter-clockwise.
struct BlockableEar {
  const std::array<glm::vec2, 3>& corners;

  /// Returns for each of the edges ab, bc and ca the side on which a point lies; +1 is the inner side.
  [[nodiscard]] std::array<int, 3> sides(const glm::vec2& p) const {
    const auto& [a, b, c] = corners;
    return {orientation(a, b, p), orientation(b, c, p), orientation(c, a, p)};
  }
  /// Whether the ear may hold a point of the box. False only if it holds none, not even on its edges.
  [[nodiscard]] bool may_hold(const glm::vec2& low, const glm::vec2& high) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec2 &from = corners[k], &to = corners[(k + 1) % 3];
      if (orientation(from, to, {to.y > from.y ? low.x : high.x, to.x > from.x ? high.y : low.y}) < 0) return false;
    }
    return true;
  }
  /// Whether the corner p of an outline blocks the ear; `before` and `after` are its neighbours.
  [[nodiscard]] bool is_blocked(const glm::vec2& p, const glm::vec2& before, const glm::vec2& after,
                                bool by_touching) const {
    const std::array<int, 3> at = sides(p);
    if (at[0] < 0 || at[1] < 0 || at[2] < 0) return false;
    const std::array<int, 3> from = sides(before), to = sides(after);
    // A corner on an edge of the ear enters only if its edge leads to the inner side.
    const auto enters = [&](const std::array<int, 3>& end) {
      return (at[0] > 0 || end[0] > 0) && (at[1] > 0 || end[1] > 0) && (at[2] > 0 || end[2] > 0);
    };
    if (enters(from) || enters(to)) return true;
    if (!by_touching || p == corners[0] || p == corners[2]) return false;
    return p != corners[1] || (from[0] >= 0 && from[1] >= 0 && to[0] >= 0 && to[1] >= 0);
  }
};

}  // namespace

/// A spatial search for the corners of a polygon that block an ear: a tree of boxes over all corners of a polygon, some
/// of which are marked. Siblings hold the same number of corners, so the depth is logarithmic. The tree keeps its
/// arrays from polygon to polygon.
class CornerTree {
 public:
  /// Builds the tree, without marks. Borrows the points and, by corner, its neighbours, which may change. O(n log n).
  void build(std::span<const glm::vec2> points, std::span<const std::uint32_t> previous,
             std::span<const std::uint32_t> next) {
    points_ = points;
    previous_ = previous;
    next_ = next;
    const auto count = std::uint32_t(points.size());
    order_.resize(count);
    std::iota(order_.begin(), order_.end(), 0u);
    leaf_of_.resize(count);
    is_marked_.assign(count, 0);
    std::size_t leaves = 1;
    while (leaves * leaf_size < count) leaves *= 2;
    nodes_.resize(2 * leaves - 1);
    nodes_[0] = {{}, {}, 0, count, 0};
    build(0);
  }
  /// Sets or clears the mark of a corner. O(log n).
  void mark(std::uint32_t corner, bool is_marked) {
    if (bool(is_marked_[corner]) == is_marked) return;
    is_marked_[corner] = is_marked;
    for (std::uint32_t node = leaf_of_[corner];; node = (node - 1) / 2) {
      nodes_[node].marked += is_marked ? 1u : ~0u;
      if (node == 0) return;
    }
  }

  /// Whether a marked corner blocks the ear a, b, c with its tip at b. A corner blocks if one of its edges leads into
  /// the ear. If `by_touching`, two more corners block: one on an edge of the ear, and one at b whose edges follow
  /// those of the ear, as it may belong to a bridge that turns there. Adds the boxes and corners tested to `work`.
  [[nodiscard]] bool blocks(const std::array<glm::vec2, 3>& ear, bool by_touching, std::uint64_t& work) const {
    const auto& [a, b, c] = ear;
    const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    const auto is_apart = [&](const glm::vec2& l, const glm::vec2& h) {
      return h.x < low.x || l.x > high.x || h.y < low.y || l.y > high.y;
    };
    const BlockableEar blockable{ear};
    std::array<std::uint32_t, 64> stack{};  // deeper than a tree of 2^32 corners
    for (std::size_t depth = 1; depth > 0;) {
      const std::uint32_t number = stack[--depth];
      const Node& node = nodes_[number];
      ++work;
      if (node.marked == 0 || is_apart(node.low, node.high) || !blockable.may_hold(node.low, node.high)) continue;
      if (!node.is_leaf()) {
        stack[depth++] = 2 * number + 1;
        stack[depth++] = 2 * number + 2;
        continue;
      }
      work += node.end - node.begin;
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const std::uint32_t corner = order_[i];
        const glm::vec2& p = points_[corner];
        if (!is_marked_[corner] || is_apart(p, p)) continue;
        if (blockable.is_blocked(p, points_[previous_[corner]], points_[next_[corner]], by_touching)) return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::uint32_t leaf_size = 8;
  /// Node i has the children 2i + 1 and 2i + 2.
  struct Node {
    glm::vec2 low, high;       ///< bounds of all its corners
    std::uint32_t begin, end;  ///< range in order_
    std::uint32_t marked;      ///< number of marked corners
    [[nodiscard]] bool is_leaf() const { return end - begin <= leaf_size; }
  };
  void build(std::uint32_t number) {
    Node& node = nodes_[number];
    node.low = node.high = points_[order_[node.begin]];
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      node.low = glm::min(node.low, points_[order_[i]]);
      node.high = glm::max(node.high, points_[order_[i]]);
    }
    if (node.is_leaf()) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) leaf_of_[order_[i]] = number;
      return;
    }
    // The halves avoid overflow: extents of huge polygons would not be finite.
    const int axis = 0.5f * node.high.x - 0.5f * node.low.x >= 0.5f * node.high.y - 0.5f * node.low.y ? 0 : 1;
    const std::uint32_t middle = node.begin + (node.end - node.begin) / 2;
    std::nth_element(order_.begin() + node.begin, order_.begin() + middle, order_.begin() + node.end,
                     [&](std::uint32_t a, std::uint32_t b) { return points_[a][axis] < points_[b][axis]; });
    nodes_[2 * number + 1] = {{}, {}, node.begin, middle, 0};
    nodes_[2 * number + 2] = {{}, {}, middle, node.end, 0};
    build(2 * number + 1);
    build(2 * number + 2);
  }

  std::span<const glm::vec2> points_;
  std::span<const std::uint32_t> previous_, next_;  ///< by corner
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> leaf_of_;  ///< by corner
  std::vector<std::uint8_t> is_marked_;
};

namespace {

/// Clamps a value to [0, 1]. NaN becomes 1, so that an undefined opacity changes nothing.
float clamped(float value) { return value < 0 ? 0.0f : (value < 1 ? value : 1.0f); }

/// Returns twice the polygon's area, projected along each axis (M. Newell).
glm::dvec3 area_vector(std::span<const glm::vec3> corners) {
  glm::dvec3 sum{0};
  const glm::dvec3 origin(corners[0]);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[i + 1]) - origin);
  return sum;
}

}  // namespace

class Triangulator::Cutter {
 public:
  std::span<const glm::uvec3> operator()(std::span<const glm::vec3> corners) {
    const auto count = std::uint32_t(corners.size());
    triangles_.clear();
    project(corners);
    if (is_flat_ && !fan_is_right()) {
      clip_ears();
      if (std::any_of(triangles_.begin(), triangles_.end(), [&](const glm::uvec3& t) { return wrong_area(t) > 0; }))
        try_all();
    } else {
      for (std::uint32_t i = 1; i + 1 < count; ++i) triangles_.emplace_back(0, i, i + 1);
    }
    return triangles_;
  }

 private:
  enum class Ear : std::uint8_t { clear, flat, touched, any };

  void project(std::span<const glm::vec3> corners) {
    const glm::dvec3 area = area_vector(corners), size = glm::abs(area);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    is_flat_ =
        size[axis] > 0 && std::all_of(corners.begin(), corners.end(), [](const glm::vec3& p) { return is_finite(p); });
    // The polygon is seen from the side that the area vector points to, so that its own turns are left turns.
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    points_.clear();
    for (const glm::vec3& p : corners)
      points_.push_back(area[axis] > 0 ? glm::vec2(p[u], p[v]) : glm::vec2(p[v], p[u]));
  }

  bool fan_is_right() const {
    for (std::size_t i = 1; i + 1 < points_.size(); ++i)
      if (orientation(points_[0], points_[i], points_[i + 1]) <= 0) return false;
    return true;
  }

  void fan(std::size_t first) {
    const auto tip = std::uint32_t(first);
    for (std::uint32_t i = next_[tip]; next_[i] != tip; i = next_[i]) triangles_.emplace_back(tip, i, next_[i]);
  }

  int turn(std::uint32_t corner) const {
    return orientation(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
  }

  void note_turn(std::uint32_t corner) {
    is_left_[corner] = turn(corner) > 0;
    blockers_.mark(corner, !is_left_[corner]);
  }

  bool is_blocked(std::uint32_t corner, bool by_touching) {
    return blockers_.blocks({points_[previous_[corner]], points_[corner], points_[next_[corner]]}, by_touching, work_);
  }

  bool is_spike(std::uint32_t corner) const {
    const glm::vec2 &a = points_[previous_[corner]], &b = points_[corner], &c = points_[next_[corner]];
    return turn(corner) == 0 && b != glm::clamp(b, glm::min(a, c), glm::max(a, c));
  }

  bool is_ear(std::uint32_t corner, Ear kind) {
    ++work_;
    switch (kind) {
      case Ear::clear: return is_left_[corner] ? !is_blocked(corner, true) : is_spike(corner);
      case Ear::flat: return !is_left_[corner] && turn(corner) == 0;
      case Ear::touched: return is_left_[corner] && !is_blocked(corner, false);
      case Ear::any: return true;
    }
    return true;
  }

  void clip(std::uint32_t corner) {
    const std::uint32_t before = previous_[corner], after = next_[corner];
    triangles_.emplace_back(before, corner, after);
    next_[before] = after;
    previous_[after] = before;
    is_left_[corner] = true;
    blockers_.mark(corner, false);  // a corner that was cut off blocks nothing
    note_turn(before);
    note_turn(after);
  }

  void clip_ears() {
    const auto count = std::uint32_t(points_.size());
    previous_.resize(count);
    next_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      previous_[i] = i == 0 ? count - 1 : i - 1;
      next_[i] = i + 1 == count ? 0 : i + 1;
    }
    is_left_.assign(count, true);
    blockers_.build(points_, previous_, next_);
    for (std::uint32_t i = 0; i < count; ++i) note_turn(i);
    // The allowed work is proportional to the file's corners, plus half a second once. This suffices for polygons of
    // millions of corners as long as an ear can always be found.
    allowed_work_ += 1000 * std::uint64_t(count);

    std::uint32_t corner = 0;
    for (std::uint32_t left = count; left > 3; --left) {
      std::uint32_t ear = corner;
      bool found = false;
      // Ears that nothing touches and spikes come first, then corners on a line with their neighbours, then touched
      // ears. The last kind accepts any corner.
      for (const Ear kind : {Ear::clear, Ear::flat, Ear::touched, Ear::any}) {
        ear = corner;
        for (std::uint32_t tried = 0; tried < left && !found && may_work(); ++tried)
          if (!(found = is_ear(ear, kind))) ear = next_[ear];
        if (found) break;
      }
      if (!found) return fan(corner);
      corner = next_[ear];
      clip(ear);
      // Skipping one corner gives rounder triangles than cutting a fan at one spot.
      corner = next_[corner];
    }
    triangles_.emplace_back(previous_[corner], corner, next_[corner]);
  }

  double wrong_area(const glm::uvec3& t) const {
    const glm::vec2 &a = points_[t.x], &b = points_[t.y], &c = points_[t.z];
    if (orientation(a, b, c) >= 0) return 0;
    const glm::dvec2 u = glm::dvec2(b) - glm::dvec2(a), v = glm::dvec2(c) - glm::dvec2(a);
    return std::max(u.y * v.x - u.x * v.y, std::numeric_limits<double>::min());
  }

  void try_all() {
    constexpr std::uint32_t most_corners = 1000;  // 16 MB; the first polygon of a file is allowed work for 580
    const auto count = std::uint32_t(points_.size());
    const std::uint64_t work = std::uint64_t(count) * count * count / 6;
    if (count > most_corners || work_ + work > allowed_work_) return;
    work_ += work;
    const auto cut = [&](std::uint32_t begin, std::uint32_t end) -> Cut& { return cuts_[begin * count + end]; };
    cuts_.assign(std::size_t(count) * count, {});
    for (std::uint32_t length = 2; length < count; ++length)
      for (std::uint32_t begin = 0, end = length; end < count; ++begin, ++end) {
        Cut best{std::numeric_limits<double>::infinity()};
        for (std::uint32_t tip = begin + 1; tip < end && best.wrong > 0; ++tip) {
          double wrong = cut(begin, tip).wrong + cut(tip, end).wrong;
          if (wrong < best.wrong) wrong += wrong_area({begin, tip, end});
          if (wrong < best.wrong) best = {wrong, tip};
        }
        cut(begin, end) = best;
      }
    triangles_.clear();
    std::vector<glm::uvec2> rest{{0, count - 1}};
    while (!rest.empty()) {
      const glm::uvec2 part = rest.back();
      rest.pop_back();
      if (part.y - part.x < 2) continue;
      const std::uint32_t tip = cut(part.x, part.y).tip;
      triangles_.emplace_back(part.x, tip, part.y);
      rest.emplace_back(part.x, tip);
      rest.emplace_back(tip, part.y);
    }
  }

  [[nodiscard]] bool may_work() const { return work_ < allowed_work_; }

  std::vector<glm::vec2> points_;               ///< counter-clockwise, exact copies of two coordinates
  std::vector<std::uint32_t> previous_, next_;  ///< rings of the remaining corners
  CornerTree blockers_;                         ///< marks corners that do not turn left: only they can block an ear
  std::vector<bool> is_left_;
  /// The best cut for the corners from begin to end: a triangle whose third corner is `tip`.
  struct Cut {
    double wrong = 0;  ///< the area of wrong winding
    std::uint32_t tip = 0;
  };
  std::vector<Cut> cuts_;  ///< at begin * count + end
  std::vector<glm::uvec3> triangles_;
  std::uint64_t work_ = 0, allowed_work_ = 1 << 25;  ///< counted in boxes and corners tested against ears
  bool is_flat_ = true;                              ///< whether the polygon has an area, and so a direction to be seen
                                                     ///< from
};

Triangulator::Triangulator() : cutter_(std::make_unique<Cutter>()) {}

Triangulator::~Triangulator() = default;

std::span<const glm::uvec3> Triangulator::operator()(std::span<const glm::vec3> corners) { return (*cutter_)(corners); }

glm::vec4 linear_color(const glm::vec4& srgb) {
  return {linear_of_srgb(srgb.r), linear_of_srgb(srgb.g), linear_of_srgb(srgb.b), clamped(srgb.a)};
}

std::string skipped_faces_warning(std::uint64_t count) {
  return "faces: " + std::to_string(count) + " with fewer than three corners were passed over";
}

void append_material(std::vector<std::uint32_t>& ids, std::size_t first, std::size_t count, std::uint32_t material) {
  if (count == 0) return;
  if (first == 0) {
    ids.assign(1, material);
  } else if (ids.size() > 1 || ids[0] != material) {
    if (ids.size() == 1) ids.assign(first, ids[0]);
    ids.resize(first + count, material);
  }
}

Mesh& add_object(Scene& scene, const std::string& name, const ModelSource& source, const std::string& place) {
  if (scene.meshes.size() >= max_objects)
    source.fail_limit(place, "more than " + std::to_string(max_objects) + " objects");
  scene.instances.push_back({.name = name, .mesh = std::uint32_t(scene.meshes.size())});
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.name = name;
  return mesh;
}

std::span<const glm::uvec3> PolygonWriter::add(std::span<const std::uint32_t> corners,
                                               std::span<const glm::vec3> positions, Mesh& mesh) {
  static constexpr std::array<glm::uvec3, 1> one_triangle{glm::uvec3(0, 1, 2)};
  const std::size_t before = mesh.triangles.size();
  std::span<const glm::uvec3> triangles;
  if (corners.size() == 3) {
    triangles = one_triangle;
  } else if (corners.size() > 3) {
    polygon_.clear();
    for (const std::uint32_t c : corners) polygon_.push_back(c < positions.size() ? positions[c] : glm::vec3(0));
    triangles = triangulate_(polygon_);
  } else {
    ++skipped_;
  }
  for (const glm::uvec3& t : triangles) mesh.triangles.emplace_back(corners[t.x], corners[t.y], corners[t.z]);
  remember_face(before, mesh);
  ++face_;
  return triangles;
}

void PolygonWriter::remember_face(std::size_t before, Mesh& mesh) const {
  // Face ids equal triangle numbers while each polygon was one triangle, so no list is kept.
  const bool needed = !mesh.face_ids.empty() || face_ != before || mesh.triangles.size() > before + 1;
  if (!needed || mesh.triangles.size() == before) return;
  if (mesh.face_ids.empty()) {
    mesh.face_ids.resize(before);
    std::iota(mesh.face_ids.begin(), mesh.face_ids.end(), 0u);
  }
  mesh.face_ids.resize(mesh.triangles.size(), face_);
}

}  // namespace frontmost
