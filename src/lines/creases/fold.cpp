// SPDX-License-Identifier: Apache-2.0
#include "lines/creases/fold.h"

#include <algorithm>
#include <cmath>

namespace frontmost::lines_detail {
namespace {

constexpr double kDegree = 0.017453292519943295;
/// A regular polygon of ten sides keeps its corners, and one of eleven is round.
constexpr double kSharp = 34 * kDegree;
constexpr double kStrong = 18 * kDegree, kWeak = 9 * kDegree;
/// A side that turns back by more is not rough: it has a crease of its own.
constexpr double kRoughest = 10 * kDegree;
const double kSharpCosine = std::cos(kSharp), kLeastCosine = std::cos(kLeastFold);
constexpr double kAhead = 0.05;      // the sine of the angle to the edge: sides of rims run along it
constexpr double kOtherSide = 0.37;  // the cosine of 68 degrees
constexpr double kFar = 3;           // times the width of the triangle on the other side
constexpr int kMostTriangles = 16;   // that are looked at around a corner

/// The plane across an edge: angles in it are those around the edge, and 0 is the left side's normal.
class CrossSection {
 public:
  CrossSection(const glm::dvec3& along, const glm::dvec3& left)
      : along_(along), up_(left - along * glm::dot(left, along)), side_(glm::cross(along, up_)) {}

  [[nodiscard]] double angle(const glm::dvec3& normal) const {
    return std::atan2(glm::dot(normal, side_), glm::dot(normal, up_));
  }
  [[nodiscard]] const glm::dvec3& along() const { return along_; }

 private:
  glm::dvec3 along_, up_, side_;
};

/// How the surface on one side of a fold turns beyond its triangle: on as the fold does, and back; not less than 0.
struct Turn {
  double on = 0, back = 0;

  [[nodiscard]] bool is_beyond(double angle) const { return angle > on || -angle > back; }
  void add(double angle) {
    on = std::max(on, angle);
    back = std::max(back, -angle);
  }
};

/// One side of a fold: its triangle, of which `tip` is not on the edge.
struct FoldSide {
  TurnedTriangle triangle;
  std::uint32_t tip;
  glm::dvec3 normal, ahead;  ///< `ahead`: along the surface and away from the edge
  double angle, width;
};

/// `sense` is 1 where greater angles go on as the fold does, and -1 else. What counts lies ahead of the tip.
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
    // Around the tip, as long as nothing is sharp.
    Fan::Side at{side.triangle, t[k]};
    glm::dvec3 last = side.normal;
    bool was_ahead = is_ahead(at.rim);
    for (int i = 0; i < kMostTriangles; ++i) {
      at = fan.beyond(at);
      if (!at.triangle.is_there() || at.triangle.number == side.triangle.number) break;
      const bool goes_ahead = is_ahead(at.rim), ahead = goes_ahead || was_ahead;
      was_ahead = goes_ahead;
      const glm::dvec3 normal = near.normal(at.triangle);
      if (glm::dot(normal, last) < kSharpCosine) {
        if (near.is_sliver(at.triangle.number)) continue;
        break;
      }
      // Beyond a cone's tip is another side of it.
      const double angle = sense * (section.angle(normal) - side.angle);
      const bool counts = ahead && glm::dot(normal, side.normal) >= kOtherSide && turn.is_beyond(angle);
      if (counts && near.is_sliver(at.triangle.number)) continue;
      if (counts) turn.add(angle);
      last = normal;
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
  if (cosine < kSharpCosine) return {FoldGrade::sharp, std::acos(std::max(cosine, -1.0))};
  if (cosine > kLeastCosine) return {};

  const glm::dvec3 begin = near.place(edge.from);
  const CrossSection section(glm::normalize(near.place(edge.to) - begin), normals[0]);
  FoldSide sides[2];
  for (int i = 0; i < 2; ++i) {
    const std::uint32_t tip = third_of(near.corners(triangles[i].number), edge.from, edge.to);
    const glm::dvec3 to_tip = near.place(tip) - begin;
    const glm::dvec3 across = to_tip - section.along() * glm::dot(to_tip, section.along());
    const double width = glm::length(across);
    sides[i] = {triangles[i], tip, normals[i], across / width, section.angle(normals[i]), width};
  }
  const double fold = sides[1].angle - sides[0].angle, angle = std::abs(fold), sense = fold < 0 ? -1 : 1;
  double jump = angle, back = 0;
  for (int i = 0; i < 2; ++i) {
    const Turn turn = turn_beyond(near, sides[i], section, i == 0 ? -sense : sense);
    const double share = std::min(1.0, kFar * sides[1 - i].width / sides[i].width);
    jump -= 0.5 * share * std::min(turn.on, angle);
    back = std::max(back, share * std::min(turn.back, kRoughest));
    if (jump - back < kWeak) return {};
  }
  jump -= back;
  return {jump < kStrong ? FoldGrade::weak : FoldGrade::strong, jump};
}

}  // namespace frontmost::lines_detail
