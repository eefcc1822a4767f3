// SPDX-License-Identifier: Apache-2.0
// A triangle's plane and sides are linear functions over the cells. Such a function has its extremes over a square at
// two corners, which the signs of its slopes select, so every question costs a few multiplications.
//
// Rounding could matter for triangles that are seen almost edge-on, are very thin or reach very far. These keep only
// the range of their distances, and their sides if these are certain. No unsafe bound is ever used: such a triangle
// only hides nothing early.
#include "lines/hiding/cell_depth.h"

#include <cmath>
#include <limits>

namespace frontmost::lines_detail {
namespace {

/// In cells. Rounding could matter farther away.
constexpr double kFarthest = 1e5;
/// Limits of length by width beyond which rounding could matter: for planes, and for which side is within.
constexpr double kThinnest = 1e4, kThinnestSide = 1e9;
/// Relative to the values; far more than the rounding error of a place in the picture.
constexpr double kDepthSlack = 1e-9, kSideSlack = 1e-5, kFloatSlack = 1e-6;

}  // namespace

CellDepth::CellDepth(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, bool is_parallel)
    : low_(std::min({a.z, b.z, c.z})), high_(std::max({a.z, b.z, c.z})), is_parallel_(is_parallel) {
  const glm::dvec3 corners[3] = {a, b, c};
  double most = 0, reach = 0;
  for (const glm::dvec3& p : corners) {
    most = std::max({most, std::abs(p.x), std::abs(p.y)});
    reach = std::max({reach, std::abs(p.x - a.x), std::abs(p.y - a.y)});
  }
  const double turn = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  const double thin = reach * reach / std::abs(turn);
  if (!(most < kFarthest && thin < kThinnestSide) || (!is_parallel && !(low_ > 0))) return;
  has_sides_ = true;
  set_sides(corners, turn > 0 ? 1 : -1);
  if (!(thin < kThinnest)) return;
  has_plane_ = true;
  const auto value = [&](double distance) { return is_parallel ? distance : 1 / distance; };
  const double at_a = value(a.z), along_b = value(b.z) - at_a, along_c = value(c.z) - at_a;
  linear_.by_x = (along_b * (c.y - a.y) - along_c * (b.y - a.y)) / turn;
  linear_.by_y = (along_c * (b.x - a.x) - along_b * (c.x - a.x)) / turn;
  linear_.at_0 = at_a - linear_.by_x * a.x - linear_.by_y * a.y;
  // An error in a place turns the plane, more for smaller triangles, and the plane may be evaluated far from the
  // triangle.
  linear_.slack = kDepthSlack * (1 + thin) *
                  (std::max(std::abs(value(low_)), std::abs(value(high_))) +
                   (std::abs(linear_.by_x) + std::abs(linear_.by_y)) * (most * 1e-3 + 0.1 / reach));
}

void CellDepth::set_sides(const glm::dvec3 (&corners)[3], double turn) {
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &p = corners[k], &q = corners[k == 2 ? 0 : k + 1];
    const double x = (q.x - p.x) * turn, y = (q.y - p.y) * turn;
    sides_[k] = {y * p.x - x * p.y, -y, x, kSideSlack * (std::abs(x) + std::abs(y))};
  }
}

double CellDepth::nearest(const Square& square) const {
  if (!has_plane_) return low_;
  const double value = linear_.at(square, is_parallel_ ? -1 : 1);
  return std::clamp(is_parallel_ ? value : 1 / value, low_, high_);
}

double CellDepth::farthest(const Square& square) const {
  if (!has_plane_) return high_;
  const double value = linear_.at(square, is_parallel_ ? 1 : -1);
  if (is_parallel_) return std::clamp(value, low_, high_);
  return value > 0 ? std::clamp(1 / value, low_, high_) : high_;
}

CellDepth::Side CellDepth::side(int k, const glm::dvec2& corner) const {
  const Linear& side = sides_[k];
  const double size = std::abs(side.by_x) + std::abs(side.by_y);
  if (!has_sides_ || !(size > 0)) return {};
  return {float(side.by_x / size), float(side.by_y / size),
          float((side.at_0 + side.by_x * corner.x + side.by_y * corner.y) / size + 2 * kSideSlack)};
}

CellDepth::Side CellDepth::plane(const glm::dvec2& corner) const {
  if (!has_plane_) return {0, 0, std::numeric_limits<float>::infinity()};
  const double sign = is_parallel_ ? -1 : 1;
  const double size = std::max(std::abs(nearness(low_, is_parallel_)), std::abs(nearness(high_, is_parallel_)));
  const double at = sign * (linear_.at_0 + linear_.by_x * corner.x + linear_.by_y * corner.y) + linear_.slack;
  const double spread = std::abs(at) + std::abs(linear_.by_x) + std::abs(linear_.by_y);
  return {float(sign * linear_.by_x), float(sign * linear_.by_y), float(at + kFloatSlack * (size + spread))};
}

CellDepth::Columns CellDepth::covered(int y, Columns all) const {
  if (!has_sides_) return {1, 0};
  for (const Linear& side : sides_) {
    const double base = side.at_0 + side.by_y * (y + double(side.by_y < 0)) - side.slack;
    const auto column = [&](double x) { return int(std::clamp(x, all.first - 2.0, all.last + 2.0)); };
    if (side.by_x > 0)
      all.first = std::max(all.first, column(std::ceil(-base / side.by_x)));
    else if (side.by_x < 0)
      all.last = std::min(all.last, column(std::floor(base / -side.by_x) - 1));
    else if (base < 0)
      return {1, 0};
    if (all.first > all.last) return {1, 0};
  }
  return all;
}

}  // namespace frontmost::lines_detail
