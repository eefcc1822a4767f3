// SPDX-License-Identifier: Apache-2.0
#include "lines/cell_depth.h"

#include <cmath>
#include <limits>

namespace frontmost::lines_detail {
namespace {

/// Cells. Beyond, and where triangles are longer than this many times their width, roundings could matter.
constexpr double kFarthest = 1e5, kThinnest = 1e4;
/// Of the values: very much more than the rounding of a place in the picture.
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
  if (!(most < kFarthest && thin < kThinnest) || (!is_parallel && !(low_ > 0))) return;
  is_known_ = true;
  const auto value = [&](double distance) { return is_parallel ? distance : 1 / distance; };
  const double at_a = value(a.z), along_b = value(b.z) - at_a, along_c = value(c.z) - at_a;
  linear_.by_x = (along_b * (c.y - a.y) - along_c * (b.y - a.y)) / turn;
  linear_.by_y = (along_c * (b.x - a.x) - along_b * (c.x - a.x)) / turn;
  linear_.at_0 = at_a - linear_.by_x * a.x - linear_.by_y * a.y;
  linear_.slack = kDepthSlack * (1 + thin) *
                  (std::max(std::abs(value(low_)), std::abs(value(high_))) +
                   (std::abs(linear_.by_x) + std::abs(linear_.by_y)) * most * 1e-3);
  set_sides(corners, turn > 0 ? 1 : -1);
}

void CellDepth::set_sides(const glm::dvec3 (&corners)[3], double turn) {
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &p = corners[k], &q = corners[k == 2 ? 0 : k + 1];
    const double x = (q.x - p.x) * turn, y = (q.y - p.y) * turn;
    sides_[k] = {y * p.x - x * p.y, -y, x, kSideSlack * (std::abs(x) + std::abs(y))};
  }
}

double CellDepth::nearest(int x, int y) const {
  if (!is_known_) return low_;
  const double value = linear_.at(x, y, is_parallel_ ? -1 : 1);
  return std::clamp(is_parallel_ ? value : 1 / value, low_, high_);
}

double CellDepth::farthest(int x, int y) const {
  if (!is_known_) return high_;
  const double value = linear_.at(x, y, is_parallel_ ? 1 : -1);
  if (is_parallel_) return std::clamp(value, low_, high_);
  return value > 0 ? std::clamp(1 / value, low_, high_) : high_;
}

CellDepth::Side CellDepth::side(int k, int x, int y) const {
  const Linear& side = sides_[k];
  const double size = std::abs(side.by_x) + std::abs(side.by_y);
  if (!is_known_ || !(size > 0)) return {};
  return {float(side.by_x / size), float(side.by_y / size),
          float((side.at_0 + side.by_x * x + side.by_y * y) / size + 2 * kSideSlack)};
}

CellDepth::Side CellDepth::plane(int x, int y) const {
  if (!is_known_) return {0, 0, std::numeric_limits<float>::infinity()};
  const double sign = is_parallel_ ? -1 : 1;
  const double size = std::max(std::abs(nearness(low_, is_parallel_)), std::abs(nearness(high_, is_parallel_)));
  const double at = sign * (linear_.at_0 + linear_.by_x * x + linear_.by_y * y) + linear_.slack;
  const double spread = std::abs(at) + std::abs(linear_.by_x) + std::abs(linear_.by_y);
  return {float(sign * linear_.by_x), float(sign * linear_.by_y), float(at + kFloatSlack * (size + spread))};
}

CellDepth::Columns CellDepth::covered(int y, Columns all) const {
  if (!is_known_) return {1, 0};
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
