// SPDX-License-Identifier: Apache-2.0
// A fold is judged in the plane across its edge:
//
//     left normal   right normal        The angle between both normals is how far the surface turns at the fold.
//             \      /                  Beyond each triangle the surface turns on by some angle, which is found by
//       _______\____/                   walking around the triangle's tip. Half of that angle is subtracted for each
//      /        edge \                  side: the rest is the jump, 0 on a cylinder however few sides it has.
//     /               .
//
// Angles are computed from tangents of half angles, and by sums of arctangents, without functions of the C library.
// Every machine rounds these operations alike, so drawings are the same on all machines.
#include <algorithm>
#include <cmath>

#include "lines/creases/creases.h"

namespace frontmost::lines_detail {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kStrong = 18 * kDegree, kWeak = 9 * kDegree;
/// The limit beside surfaces that turn evenly, and by less than kEven times the jump.
constexpr double kStrongBesideEven = 12 * kDegree, kEven = 0.5;
constexpr double kOneWay = 0.25;  // the most that a side turns the other way, as a share, to count as turning one way
/// A side that turns back by more is not rough: it has a crease of its own.
constexpr double kRoughest = 10 * kDegree;
/// The cosine of 34 degrees: a regular polygon of ten sides keeps its corners, and one of eleven is round.
constexpr double kSharpCosine = 0.82903757255504162;
constexpr double kAhead = 0.05;      // the least sine of the angle to the edge: sides of rims run along it
constexpr double kOtherSide = 0.37;  // the cosine of 68 degrees
constexpr double kFar = 3;           // times the width of the triangle on the other side
constexpr int kMostTriangles = 16;   // the most that are visited around a corner

/// The tangent of half the angle with this sine and cosine, times any length. Grows with the angle, from -pi to pi.
double half_tangent(double sine, double cosine) {
  const double sum = std::sqrt(sine * sine + cosine * cosine) + cosine;
  return sum > 0 ? sine / sum : 0;
}

/// The angle for the tangent of its half, which is not less than 0. Correct to 1e-7 up to 90 degrees.
double angle_of(double half) {
  const double t = half / (1 + std::sqrt(1 + half * half)), square = t * t;
  double sum = 0;
  for (int n = 15; n > 0; n -= 2) sum = 1.0 / n - square * sum;
  return 4 * t * sum;
}

/// The angle between two vectors; pi / 2 for all that are wider.
double angle_between(const glm::dvec3& n, const glm::dvec3& m) {
  const double cosine = glm::dot(n, m);
  return angle_of(cosine > 0 ? half_tangent(glm::length(glm::cross(n, m)), cosine) : 1);
}

/// The plane across an edge. A surface normal in that plane is a complex number. Its argument is the angle from the
/// left side's normal, around the edge.
class CrossSection {
 public:
  CrossSection(const glm::dvec3& along, const glm::dvec3& left)
      : along_(along), up_(left - along * glm::dot(left, along)), side_(glm::cross(along, up_)) {}

  [[nodiscard]] glm::dvec2 direction(const glm::dvec3& normal) const {
    return {glm::dot(normal, up_), glm::dot(normal, side_)};
  }
  [[nodiscard]] const glm::dvec3& along() const { return along_; }

 private:
  glm::dvec3 along_, up_, side_;
};

/// half_tangent() of the angle from one direction to another.
double turn_between(const glm::dvec2& from, const glm::dvec2& to) {
  return half_tangent(from.x * to.y - from.y * to.x, glm::dot(from, to));
}

/// How far the surface on one side of a fold turns beyond its triangle: in the sense of the fold (`on`), and against it
/// (`back`). Tangents of half the angles, not less than 0.
struct Turn {
  double on = 0, back = 0;

  [[nodiscard]] double most() const { return std::max(on, back); }
  /// True for a cylinder or a plane; a rough surface turns both ways.
  [[nodiscard]] bool is_one_way() const { return std::min(on, back) <= kOneWay * most(); }
  [[nodiscard]] bool is_beyond(double half) const { return half > on || -half > back; }
  void add(double half) {
    on = std::max(on, half);
    back = std::max(back, -half);
  }
};

/// The fold's angle, less what the sides take off.
class Jump {
 public:
  explicit Jump(double half) : half_(half), angle_(angle_of(half)) {}

  /// Subtracts half the turn of a side, weighted by `share`, 0 to 1.
  void take_off(const Turn& turn, double share) {
    angle_ -= 0.5 * share * angle_of(std::min(turn.on, half_));
    rough_ = std::max(rough_, share * std::min(angle_of(turn.back), kRoughest));
    most_ = std::max(most_, angle_of(turn.most()));
    is_even_ = is_even_ && turn.is_one_way();
  }
  [[nodiscard]] double angle() const { return is_clear() ? angle_ : angle_ - rough_; }
  /// Never rises as more is taken off.
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
  glm::dvec2 direction;      ///< of the normal, in the cross-section
  double width;
};

/// `sense` is 1 where larger angles turn in the sense of the fold, and -1 else. Only surface ahead of the tip counts.
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
    // Walks around the tip, as long as nothing is sharp.
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
      // Beyond a cone's tip lies the other side of the cone.
      if (!ahead || glm::dot(normal, side.normal) < kOtherSide) continue;
      const double half = sense * turn_between(side.direction, section.direction(normal));
      if (turn.is_beyond(half) && !near.is_sliver(at.triangle.number)) turn.add(half);
    }
  }
  return turn;
}

}  // namespace

JudgedFold judge_fold(const Neighbours& near, const FeatureEdge& edge) {
  const bool is_alike =
      runs(near.corners(edge.left), edge.from, edge.to) != runs(near.corners(edge.right), edge.from, edge.to);
  const TurnedTriangle triangles[2] = {{edge.left, false}, {edge.right, !is_alike}};
  const glm::dvec3 normals[2] = {near.surface_normal(triangles[0]), near.surface_normal(triangles[1])};
  const double cosine = glm::dot(normals[0], normals[1]);
  if (cosine < kSharpCosine) return {FoldGrade::sharp, angle_between(normals[0], normals[1])};
  if (cosine > kLeastFoldCosine) return {};

  const glm::dvec3 begin = near.place(edge.from);
  const CrossSection section(glm::normalize(near.place(edge.to) - begin), normals[0]);
  FoldSide sides[2];
  for (int i = 0; i < 2; ++i) {
    const std::uint32_t tip = third_of(near.corners(triangles[i].number), edge.from, edge.to);
    const glm::dvec3 to_tip = near.place(tip) - begin;
    const glm::dvec3 across = to_tip - section.along() * glm::dot(to_tip, section.along());
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

}  // namespace frontmost::lines_detail
