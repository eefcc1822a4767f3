// SPDX-License-Identifier: Apache-2.0
// Each fold is judged by the surfaces beside it, in the plane across its edge; then with folds that share vertices.
//
//     left normal   right normal        The angle between both normals is how far the surface turns at the fold.
//             \      /                  Beyond each triangle the surface turns on by some angle, which is found by
//       _______\____/                   walking around the triangle's tip. Half of that angle is subtracted for each
//      /        edge \                  side: the rest is the jump, 0 on a cylinder however few sides it has.
//
// Angles are computed from tangents of half angles, and by sums of arctangents, without functions of the C library.
// Every machine rounds these operations alike, so drawings are the same on all machines.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "base/parallel.h"
#include "geometry/buckets.h"
#include "lines/mesh/feature_edges.h"
#include "lines/mesh/mesh.h"

namespace frontmost::lines_detail {
namespace {

constexpr double kWidestCorner = 0.9659;  // the cosine of 15 degrees: slivers have a corner of more than 165 degrees
constexpr double kOnePlane = 0.996;       // the cosine of 5 degrees
constexpr std::size_t kTrianglesPerPart = 4096;
constexpr std::size_t kMostSlivers = 8;  // more slivers in one plane form a piece that is no sliver

/// A triangle on a walk from neighbour to neighbour. `is_turned`: it is wound against the triangle at which the walk
/// began.
struct TurnedTriangle {
  std::uint32_t number = no_index;
  bool is_turned = false;

  [[nodiscard]] bool is_there() const { return number != no_index; }
};

/// Whether the triangle's winding runs from vertex a to vertex b, and not from b to a.
bool runs(const glm::uvec3& triangle, std::uint32_t a, std::uint32_t b) {
  return (triangle.x == a && triangle.y == b) || (triangle.y == a && triangle.z == b) ||
         (triangle.z == a && triangle.x == b);
}

/// The triangles around a vertex, for walking around it.
class Fan {
 public:
  static constexpr std::size_t most = 32;  ///< triangles; a vertex with more has an empty fan

  struct Side {
    TurnedTriangle triangle;
    std::uint32_t rim;  ///< the vertex at the other end of this side
    std::size_t entry;  ///< the triangle's index in the fan
  };

  /// The side of `triangle`, a triangle of the fan, that leads from the fan's vertex to `rim`.
  [[nodiscard]] Side side(const TurnedTriangle& triangle, std::uint32_t rim) const {
    std::size_t entry = 0;
    while (entry < count_ && entries_[entry].triangle != triangle.number) ++entry;
    return {triangle, rim, entry};
  }

  /// Crosses a side: returns the triangle beyond it, with that triangle's other side at the vertex. Copies of a
  /// triangle count once. Returns no triangle if several different ones lie beyond.
  [[nodiscard]] Side beyond(const Side& side) const {
    Side found{{}, no_index, count_};
    if (side.entry >= count_) return found;
    std::uint32_t beside = 0;  // bit i: entry i has the rim
    for (std::size_t i = 0; i < count_; ++i)
      beside |= std::uint32_t(entries_[i].next == side.rim || entries_[i].last == side.rim) << i;
    beside &= ~(1u << side.entry);
    const Entry& own = entries_[side.entry];
    const std::uint32_t own_rim = own.next == side.rim ? own.last : own.next;
    for (; beside != 0; beside &= beside - 1) {
      const Side other = to(std::size_t(std::countr_zero(beside)), side);
      if (other.rim == own_rim || other.rim == found.rim) continue;
      if (found.triangle.is_there()) return {{}, no_index, count_};
      found = other;
    }
    return found;
  }

 private:
  friend class Neighbours;
  struct Entry {
    std::uint32_t triangle, next, last;
  };

  /// Crosses from the side `from` to an entry with the same rim, and returns that entry's other side.
  [[nodiscard]] Side to(std::size_t entry, const Side& from) const {
    const Entry& own = entries_[from.entry];
    const Entry& other = entries_[entry];
    const bool is_alike = (other.next == from.rim) != (own.next == from.rim);
    const std::uint32_t rim = other.next == from.rim ? other.last : other.next;
    return {{other.triangle, from.triangle.is_turned == is_alike}, rim, entry};
  }

  std::array<Entry, most> entries_;
  std::size_t count_ = 0;
};

class Neighbours {
 public:
  Neighbours(const SeenMesh& seen, const CornerTable& table, const Execution& execution)
      : seen_(seen), table_(table), is_sliver_(seen.mesh.triangles.size()) {
    parallel_for(execution, is_sliver_.size(), kTrianglesPerPart, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) is_sliver_[i] = find_sliver(std::uint32_t(i));
    });
  }

  [[nodiscard]] const glm::uvec3& corners(std::uint32_t triangle) const { return seen_.mesh.triangles[triangle]; }
  [[nodiscard]] glm::dvec3 place(std::uint32_t vertex) const { return seen_.mesh.positions[vertex]; }

  /// As Fan::beyond(), for the side from vertex a to vertex b. O(triangles at a).
  [[nodiscard]] TurnedTriangle beyond(const TurnedTriangle& triangle, std::uint32_t a, std::uint32_t b) const {
    const WeldedMesh& mesh = seen_.mesh;
    const std::uint32_t own = third_of(corners(triangle.number), a, b);
    std::uint32_t found = no_index, opposite = no_index;
    for (const Corner& corner : table_[a]) {
      const std::uint32_t next = corner.next(mesh), last = corner.last(mesh);
      if (next != b && last != b) continue;
      const std::uint32_t third = next == b ? last : next;
      if (third == own || third == opposite) continue;
      if (found != no_index) return {};
      found = corner.triangle();
      opposite = third;
    }
    if (found == no_index) return {};
    const bool is_alike = runs(corners(triangle.number), a, b) != runs(corners(found), a, b);
    return {found, triangle.is_turned == is_alike};
  }

  [[nodiscard]] Fan fan(std::uint32_t vertex) const {
    Fan fan;
    const std::span<const Corner> corners = table_[vertex];
    if (corners.size() > Fan::most) return fan;
    for (const Corner& corner : corners)
      fan.entries_[fan.count_++] = {corner.triangle(), corner.next(seen_.mesh), corner.last(seen_.mesh)};
    return fan;
  }

  /// The triangle's own normal, of unit length or zero.
  [[nodiscard]] glm::dvec3 normal(const TurnedTriangle& triangle) const {
    glm::dvec3 normal(seen_.triangles[triangle.number].normal);
    if (normal == glm::dvec3(0)) normal = unit_of(normal_of(seen_.mesh, triangle.number));
    return triangle.is_turned ? -normal : normal;
  }
  /// Whether the corners lie almost on a line, one between the other two. The normal of such a triangle says little
  /// about its surface: a sliver between three vertices of a cylinder's rim lies in the rim's plane.
  [[nodiscard]] bool is_sliver(std::uint32_t triangle) const { return is_sliver_[triangle] != 0; }

  /// The normal of the surface that the triangle is cut from. A sliver that is not part of something wider takes the
  /// neighbour's normal that is nearest to its own.
  [[nodiscard]] glm::dvec3 surface_normal(const TurnedTriangle& triangle) const {
    const glm::dvec3 own = normal(triangle);
    if (!is_sliver(triangle.number)) return own;
    std::array<TurnedTriangle, kMostSlivers> piece;  // the slivers of one plane
    piece[0] = triangle;
    std::size_t count = 1;
    const auto has = [&](std::uint32_t number) {
      return std::any_of(piece.begin(), piece.begin() + std::ptrdiff_t(count),
                         [&](const TurnedTriangle& sliver) { return sliver.number == number; });
    };
    glm::dvec3 nearest = own;
    double cosine = -2;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::uvec3& t = corners(piece[i].number);
      for (int k = 0; k < 3; ++k) {
        const TurnedTriangle other = beyond(piece[i], t[k], t[k == 2 ? 0 : k + 1]);
        if (!other.is_there() || has(other.number)) continue;
        const bool is_thin = is_sliver(other.number);
        const glm::dvec3 its = normal(other);
        const double along = glm::dot(its, own);
        if (along > kOnePlane) {
          if (!is_thin || count == piece.size()) return own;
          piece[count++] = other;
        } else if (!is_thin && along > cosine) {
          cosine = along;
          nearest = its;
        }
      }
    }
    return nearest;
  }

 private:
  [[nodiscard]] bool find_sliver(std::uint32_t triangle) const {
    const glm::uvec3& t = corners(triangle);
    const glm::dvec3 a = place(t.x), b = place(t.y), c = place(t.z), sides[3] = {b - a, c - b, a - c};
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 &u = sides[k], &v = sides[k == 2 ? 0 : k + 1];
      const double dot = glm::dot(u, v);
      // A triangle has at most one corner wider than a right angle.
      if (dot > 0) return dot * dot > kWidestCorner * kWidestCorner * glm::dot(u, u) * glm::dot(v, v);
    }
    return false;
  }

  const SeenMesh& seen_;
  const CornerTable& table_;
  Buffer<std::uint8_t> is_sliver_;  ///< by triangle
};

enum class FoldGrade : std::uint8_t {
  smooth,
  weak,    ///< a crease only if it continues a strong fold
  strong,  ///< a crease
  sharp,   ///< a crease whatever is beside it
};

struct JudgedFold {
  FoldGrade grade = FoldGrade::smooth;
  double jump = 0;  ///< radians: by how much the surfaces on both sides differ at the edge
};

constexpr double kDegree = 0.017453292519943295;
constexpr double kStrong = 18 * kDegree, kWeak = 9 * kDegree;
/// Replaces kStrong if the surfaces on both sides turn evenly, and by at most kEven times the jump.
constexpr double kStrongBesideEven = 12 * kDegree, kEven = 0.5;
constexpr double kOneWay = 0.25;  // a side counts as turning one way if it turns back by at most this share
/// The greatest angle that counts as roughness: a side that turns back by more has a crease of its own.
constexpr double kRoughest = 10 * kDegree;
/// The cosine of 34 degrees: a regular polygon of ten sides keeps its corners, and one of eleven is round.
constexpr double kSharpCosine = 0.82903757255504162;
constexpr double kAhead = 0.05;      // the least sine of the angle between the edge and a side that leads ahead
constexpr double kOtherSide = 0.37;  // the cosine of 68 degrees
constexpr double kFar = 3;  // a triangle counts less if it is wider than this many times the triangle on the other side
constexpr int kMostTriangles = 16;  // the most triangles that a walk around a corner visits

/// The tangent of half an angle. `sine` and `cosine` may both be multiplied by any positive factor. The tangent grows
/// with the angle, from -pi to pi.
double half_tangent(double sine, double cosine) {
  const double sum = std::sqrt(sine * sine + cosine * cosine) + cosine;
  return sum > 0 ? sine / sum : 0;
}

/// The angle whose half has the tangent `half`, which is not less than 0. Correct to 1e-7 up to 90 degrees.
double angle_of(double half) {
  const double t = half / (1 + std::sqrt(1 + half * half)), square = t * t;
  double sum = 0;
  for (int n = 15; n > 0; n -= 2) sum = 1.0 / n - square * sum;
  return 4 * t * sum;
}

/// The plane perpendicular to an edge. A surface normal, projected to this plane, is a complex number. Its argument is
/// the angle around the edge from the left side's normal.
struct CrossSection {
  CrossSection(const glm::dvec3& edge, const glm::dvec3& left)
      : along(edge), up(left - along * glm::dot(left, along)), side(glm::cross(along, up)) {}

  [[nodiscard]] glm::dvec2 direction(const glm::dvec3& normal) const {
    return {glm::dot(normal, up), glm::dot(normal, side)};
  }

  glm::dvec3 along, up, side;
};

/// half_tangent() of the angle from one direction to another.
double turn_between(const glm::dvec2& from, const glm::dvec2& to) {
  return half_tangent(from.x * to.y - from.y * to.x, glm::dot(from, to));
}

/// How far the surface on one side of a fold turns beyond the triangle there: in the sense of the fold (`on`), and
/// against that sense (`back`). Both are tangents of half the angles, not less than 0.
struct Turn {
  double on = 0, back = 0;

  [[nodiscard]] double most() const { return std::max(on, back); }
  /// Whether the surface turns in one sense only, as a cylinder or a plane does; a rough surface turns both ways.
  [[nodiscard]] bool is_one_way() const { return std::min(on, back) <= kOneWay * most(); }
  [[nodiscard]] bool is_beyond(double half) const { return half > on || -half > back; }
  void add(double half) {
    on = std::max(on, half);
    back = std::max(back, -half);
  }
};

/// The fold's angle, from which the turns of both sides are subtracted.
class Jump {
 public:
  explicit Jump(double half) : half_(half), angle_(angle_of(half)) {}

  /// Subtracts half of the turn of one side, weighted by `share` (0 to 1).
  void take_off(const Turn& turn, double share) {
    angle_ -= 0.5 * share * angle_of(std::min(turn.on, half_));
    rough_ = std::max(rough_, share * std::min(angle_of(turn.back), kRoughest));
    most_ = std::max(most_, angle_of(turn.most()));
    is_even_ = is_even_ && turn.is_one_way();
  }
  [[nodiscard]] double angle() const { return is_clear() ? angle_ : angle_ - rough_; }
  /// A further take_off() never raises the grade.
  [[nodiscard]] FoldGrade grade() const {
    if (is_clear() || angle() >= kStrong) return FoldGrade::strong;
    return angle() < kWeak ? FoldGrade::smooth : FoldGrade::weak;
  }

 private:
  [[nodiscard]] bool is_clear() const { return is_even_ && angle_ >= kStrongBesideEven && most_ <= kEven * angle_; }

  double half_, angle_, rough_ = 0, most_ = 0;
  bool is_even_ = true;
};

/// One side of a fold: its triangle, whose vertex `tip` is not on the edge.
struct FoldSide {
  TurnedTriangle triangle;
  std::uint32_t tip;
  glm::dvec3 normal, ahead;  ///< `ahead`: along the surface and away from the edge
  glm::dvec2 direction;      ///< direction of the normal, in the cross-section
  double width;
};

/// `sense` is 1 where larger angles turn in the sense of the fold, else -1. Only surface ahead of the tip counts.
Turn turn_beyond(const Neighbours& near, const FoldSide& side, const CrossSection& section, double sense) {
  const auto is_ahead = [&](std::uint32_t rim) {
    const glm::dvec3 step = near.place(rim) - near.place(side.tip);
    const double by = glm::dot(step, side.ahead);
    return by > 0 && by * by > kAhead * kAhead * glm::dot(step, step);
  };
  Turn turn;
  const Fan fan = near.fan(side.tip);
  const glm::uvec3& t = near.corners(side.triangle.number);
  for (int k = 0; k < 3; ++k) {
    if (t[k] == side.tip) continue;
    // Walks around the tip as far as the next sharp fold.
    Fan::Side at = fan.side(side.triangle, t[k]);
    glm::dvec3 last = side.normal;
    bool was_ahead = is_ahead(at.rim);
    for (int i = 0; i < kMostTriangles; ++i) {
      at = fan.beyond(at);
      if (!at.triangle.is_there()) break;
      if (at.triangle.number == side.triangle.number) return turn;  // once around
      const bool goes_ahead = is_ahead(at.rim), ahead = goes_ahead || was_ahead;
      was_ahead = goes_ahead;
      const glm::dvec3 normal = near.normal(at.triangle);
      if (glm::dot(normal, last) < kSharpCosine) {
        if (near.is_sliver(at.triangle.number)) continue;
        break;
      }
      last = normal;
      // Beyond a cone's tip lies the other side of the cone, which does not count.
      if (!ahead || glm::dot(normal, side.normal) < kOtherSide) continue;
      const double half = sense * turn_between(side.direction, section.direction(normal));
      if (turn.is_beyond(half) && !near.is_sliver(at.triangle.number)) turn.add(half);
    }
  }
  return turn;
}

/// A chamfer or a cone's rim jumps by its whole angle, the edge between a plane and a fillet by half. Two rules adjust
/// the grade. A side that turns back is rough, and the fold has to be deeper by as much. If each side turns one way
/// only, by at most half of the jump, fainter folds count. A side counts little if its triangle is much wider than the
/// triangle on the other side. O(triangles at the corners of both triangles).
JudgedFold judge_fold(const Neighbours& near, const FeatureEdge& edge) {
  const bool is_alike =
      runs(near.corners(edge.left), edge.from, edge.to) != runs(near.corners(edge.right), edge.from, edge.to);
  const TurnedTriangle triangles[2] = {{edge.left, false}, {edge.right, !is_alike}};
  const glm::dvec3 normals[2] = {near.surface_normal(triangles[0]), near.surface_normal(triangles[1])};
  const double cosine = glm::dot(normals[0], normals[1]);
  if (cosine < kSharpCosine) {
    const double half = cosine > 0 ? half_tangent(glm::length(glm::cross(normals[0], normals[1])), cosine) : 1;
    return {FoldGrade::sharp, angle_of(half)};
  }
  if (cosine > kLeastFoldCosine) return {};

  const glm::dvec3 begin = near.place(edge.from);
  const CrossSection section(glm::normalize(near.place(edge.to) - begin), normals[0]);
  FoldSide sides[2];
  for (int i = 0; i < 2; ++i) {
    const std::uint32_t tip = third_of(near.corners(triangles[i].number), edge.from, edge.to);
    const glm::dvec3 to_tip = near.place(tip) - begin;
    const glm::dvec3 across = to_tip - section.along * glm::dot(to_tip, section.along);
    const double width = glm::length(across);
    sides[i] = {triangles[i], tip, normals[i], across / width, section.direction(normals[i]), width};
  }
  const double fold = turn_between(sides[0].direction, sides[1].direction), half = std::abs(fold);
  const double sense = fold < 0 ? -1 : 1;
  Jump jump(half);
  for (int i = 0; i < 2; ++i) {
    const double share = std::min(1.0, kFar * sides[1 - i].width / sides[i].width);
    jump.take_off(turn_beyond(near, sides[i], section, i == 0 ? -sense : sense), share);
    if (jump.grade() == FoldGrade::smooth) return {};
  }
  return {jump.grade(), jump.angle()};
}

constexpr std::size_t kEdgesPerPart = 256;
constexpr double kGoesOn = 0.5;     // the least cosine of the angle between a crease and its continuation
constexpr double kBend = 0.25;      // the least cosine between two edges that count as one line
constexpr double kFaintest = 0.75;  // share of a triangle's greatest jump below which its faintest crease is removed
constexpr std::size_t kFewestEdges = 3;   // a line of so many edges may end in the air
constexpr std::size_t kFewestAlone = 10;  // a line of so many edges may end in the air at both ends
constexpr double kLong = 0.05;            // share of the mesh's diagonal: a longer line may end in the air

/// Folds need judgement, except sharp edges that the mesh states.
bool needs_judgement(const FeatureEdge& edge, const WeldedMesh& mesh) {
  return (edge.kind == EdgeKind::crease || edge.kind == EdgeKind::silhouette) &&
         !mesh.stated.are_sharp(edge.from, edge.to);
}

std::vector<JudgedFold> judge_folds(const SeenMesh& seen, const CornerTable& table,
                                    const std::vector<FeatureEdge>& edges, const Execution& execution) {
  const Neighbours near(seen, table, execution);
  std::vector<JudgedFold> folds(edges.size());
  parallel_for(execution, edges.size(), kEdgesPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      folds[i] = needs_judgement(edges[i], seen.mesh)
                     ? judge_fold(near, edges[i])
                     : JudgedFold{FoldGrade::sharp, std::numeric_limits<double>::infinity()};
  });
  return folds;
}

class CreaseGraph {
 public:
  CreaseGraph(const WeldedMesh& mesh, const std::vector<FeatureEdge>& edges, std::vector<JudgedFold> folds,
              const Execution& execution)
      : mesh_(mesh), edges_(edges), execution_(execution), folds_(std::move(folds)) {
    const auto list = [&](std::size_t i, const auto& add) {
      if (folds_[i].grade == FoldGrade::smooth) return;
      add(edges_[i].from, std::uint32_t(i));
      add(edges_[i].to, std::uint32_t(i));
    };
    edges_at_ = Buckets<std::uint32_t>(mesh.positions.size(), edges_.size(), list, execution);
  }

  /// Makes each weak fold strong that continues a strong fold.
  void follow_strong() {
    std::vector<std::uint32_t> open;
    for (std::size_t i = 0; i < edges_.size(); ++i)
      if (is_drawn(i) && needs_judgement(edges_[i], mesh_)) open.push_back(std::uint32_t(i));
    while (!open.empty()) {
      const std::uint32_t edge = open.back();
      open.pop_back();
      for (const std::uint32_t vertex : {edges_[edge].from, edges_[edge].to})
        for (const std::uint32_t next : edges_at_[vertex]) {
          if (folds_[next].grade != FoldGrade::weak || bend(edge, next, vertex) < kGoesOn) continue;
          folds_[next].grade = FoldGrade::strong;
          open.push_back(next);
        }
    }
  }

  /// Removes the faintest crease of triangles with three, as where a crease zigzags across a row of triangles.
  void thin() {
    const auto for_each_side = [&](const auto& visit) {
      for (std::size_t i = 0; i < edges_.size(); ++i)
        if (is_drawn(i) && needs_judgement(edges_[i], mesh_))
          for (const std::uint32_t triangle : {edges_[i].left, edges_[i].right}) visit(triangle, std::uint32_t(i));
    };
    Buffer<std::uint8_t> creases(mesh_.triangles.size(), 0);
    for_each_side([&](std::uint32_t triangle, std::uint32_t) { ++creases[triangle]; });
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;  // triangle, edge
    for_each_side([&](std::uint32_t triangle, std::uint32_t edge) {
      if (creases[triangle] == 3) sides.emplace_back(triangle, edge);
    });
    std::sort(sides.begin(), sides.end());
    std::vector<std::uint32_t> faint;
    const auto less = [&](const auto& a, const auto& b) { return folds_[a.second].jump < folds_[b.second].jump; };
    for (std::size_t i = 0; i + 2 < sides.size(); i += 3) {
      const auto [least, most] = std::minmax_element(&sides[i], &sides[i] + 3, less);
      const JudgedFold& fold = folds_[least->second];
      if (fold.grade == FoldGrade::strong && fold.jump < kFaintest * folds_[most->second].jump)
        faint.push_back(least->second);
    }
    for (const std::uint32_t edge : faint) folds_[edge].grade = FoldGrade::smooth;
  }

  void cut_short_ends() {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    std::vector<std::uint32_t> tips;
    for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v) {
      low = glm::min(low, mesh_.positions[v]);
      high = glm::max(high, mesh_.positions[v]);
      if (drawn_at(v) == 1) tips.push_back(v);
    }
    const double least = kLong * glm::distance(low, high);
    for (std::size_t i = 0; i < tips.size(); ++i) {
      if (i % kEdgesPerPart == 0) check_cancelled(execution_);
      if (drawn_at(tips[i]) != 1) continue;
      const std::vector<std::uint32_t> line = line_from(tips[i]);
      double length = 0;
      for (const std::uint32_t edge : line)
        length += glm::distance(mesh_.positions[edges_[edge].from], mesh_.positions[edges_[edge].to]);
      if (line.empty() || line.size() >= kFewestAlone || length > least) continue;
      const std::uint32_t end = end_of(line, tips[i]);
      if (line.size() >= kFewestEdges && drawn_at(end) != 1) continue;
      for (const std::uint32_t edge : line) folds_[edge].grade = FoldGrade::smooth;
      // A line that met the removed one may end in the air now, or go on to a tip.
      if (drawn_at(end) == 1) tips.push_back(end);
      if (drawn_at(end) != 2) continue;
      for (const std::uint32_t edge : edges_at_[end])
        if (is_drawn(edge))
          if (const std::uint32_t tip = end_of(line_along(edge, end), end); drawn_at(tip) == 1) tips.push_back(tip);
    }
  }

  [[nodiscard]] bool is_drawn(std::size_t edge) const { return folds_[edge].grade >= FoldGrade::strong; }

 private:
  [[nodiscard]] std::uint32_t other_end(std::uint32_t edge, std::uint32_t vertex) const {
    return edges_[edge].from == vertex ? edges_[edge].to : edges_[edge].from;
  }
  /// The unit direction of the edge, away from one of its ends.
  [[nodiscard]] glm::dvec3 direction_from(std::uint32_t edge, std::uint32_t vertex) const {
    return glm::normalize(mesh_.positions[other_end(edge, vertex)] - mesh_.positions[vertex]);
  }
  /// The cosine of the angle by which a line that goes from `edge` to `next` bends at `vertex`.
  [[nodiscard]] double bend(std::uint32_t edge, std::uint32_t next, std::uint32_t vertex) const {
    return -glm::dot(direction_from(edge, vertex), direction_from(next, vertex));
  }
  [[nodiscard]] std::size_t drawn_at(std::uint32_t vertex) const {
    const std::span<const std::uint32_t> here = edges_at_[vertex];
    return std::size_t(std::count_if(here.begin(), here.end(), [&](std::uint32_t e) { return is_drawn(e); }));
  }

  /// The edges of the line that begins at `tip`, a vertex with one drawn edge.
  [[nodiscard]] std::vector<std::uint32_t> line_from(std::uint32_t tip) const {
    for (const std::uint32_t edge : edges_at_[tip])
      if (is_drawn(edge)) return line_along(edge, tip);
    return {};
  }
  /// The edges of the line that goes from `vertex` along `edge`. The line ends where other edges meet it, where it
  /// bends sharply, or after kFewestAlone edges.
  [[nodiscard]] std::vector<std::uint32_t> line_along(std::uint32_t edge, std::uint32_t vertex) const {
    std::vector<std::uint32_t> line;
    while (edge != no_index && needs_judgement(edges_[edge], mesh_)) {
      if (!line.empty() && bend(line.back(), edge, vertex) < kBend) break;
      line.push_back(edge);
      vertex = other_end(edge, vertex);
      if (line.size() == kFewestAlone || drawn_at(vertex) != 2) break;
      edge = no_index;
      for (const std::uint32_t next : edges_at_[vertex])
        if (is_drawn(next) && next != line.back()) edge = next;
    }
    return line;
  }
  [[nodiscard]] std::uint32_t end_of(const std::vector<std::uint32_t>& line, std::uint32_t vertex) const {
    for (const std::uint32_t edge : line) vertex = other_end(edge, vertex);
    return vertex;
  }

  const WeldedMesh& mesh_;
  const std::vector<FeatureEdge>& edges_;
  const Execution& execution_;
  std::vector<JudgedFold> folds_;
  Buckets<std::uint32_t> edges_at_;  ///< by vertex
};

}  // namespace

void judge_creases(const SeenMesh& seen, const CornerTable& table, std::vector<FeatureEdge>& edges,
                   const Execution& execution) {
  CreaseGraph graph(seen.mesh, edges, judge_folds(seen, table, edges, execution), execution);
  graph.follow_strong();
  graph.thin();
  graph.cut_short_ends();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (edges[i].kind != EdgeKind::crease || graph.is_drawn(i)) edges[kept++] = edges[i];
  edges.resize(kept);
}

}  // namespace frontmost::lines_detail
